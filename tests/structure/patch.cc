// SPDX-License-Identifier: GPL-3.0-or-later
// Patch test: a linear displacement of an irregular mesh gives the analytic stress in every element
// and no force on any node inside; a rigid rotation by 50 degrees in one step gives none at all,
// and turns a stress that is there. Both integrations, rate form and hyperelastic, 2-D and 3-D.
#include "bodies.h"

#include <set>

using namespace coracle;

namespace
{
constexpr double lambda = 1e6 * 0.3 / (1.3 * 0.4), mu = 1e6 / 2.6;

std::string
text(const std::string &integration, const std::string &model, const std::string &mesh)
{
  return "subsection Materials\n subsection m\n set Model = " + model +
         "\n set Density = 1000\n set Young modulus = 1 MPa\n set Poisson ratio = 0.3\n end\nend\n"
         "subsection Bodies\n subsection body\n set Material = m\n set Integration = " +
         integration + "\n subsection Mesh\n" + mesh + "\n end\n end\nend\n";
}

/// Move every node by a map of its present position, as one step.
template <int dim, typename Map>
void
move_by(SolidBody<dim> &body, const Map &map)
{
  using Node = NodeColumns<dim>;
  for (unsigned int n = 0; n < body.mesh().n_nodes(); ++n)
    {
      const dealii::Tensor<1, dim> x = body.position(n), y = map(x);
      for (int d = 0; d < dim; ++d)
        {
          body.nodes()[Node::increment + d][n] = y[d] - x[d];
          body.nodes()[Node::position + d][n]  = y[d];
        }
    }
  body.update_stress(1e-3);
}

/// Largest internal force of a node inside and of a node on the surface.
template <int dim>
std::array<double, 2>
largest_forces(const SolidBody<dim> &body)
{
  const std::set<unsigned int> surface(body.surface_nodes().begin(), body.surface_nodes().end());
  std::array<double, 2>        largest{};
  for (unsigned int n = 0; n < body.mesh().n_nodes(); ++n)
    for (int d = 0; d < dim; ++d)
      {
        double &value = largest[surface.count(n)];
        value         = std::max(value, std::fabs(body.nodes()[NodeColumns<dim>::internal + d][n]));
      }
  return largest;
}

template <int dim>
double
worst_stress_error(const SolidBody<dim> &body, const Symmetric<dim, double> &exact)
{
  double worst = 0;
  for (unsigned int e = 0; e < body.mesh().n_elements(); ++e)
    for (int c = 0; c < exact.size; ++c)
      worst = std::max(worst, std::fabs(body.stress(e)[c] - exact[c]));
  return worst;
}

template <int dim>
Symmetric<dim, double>
exact_stress(const Matrix<dim, double> &f, const bool hyperelastic)
{
  Symmetric<dim, double> s;
  const double           j = determinant<dim, double>(f);
  if (hyperelastic)
    {
      for (int i = 0; i < dim; ++i)
        for (int k = i; k < dim; ++k)
          for (int l = 0; l < dim; ++l)
            s(i, k) += mu * f[i][l] * f[k][l] / j;
      if (dim == 2)
        s[2] = mu / j;
      for (int i = 0; i < 3; ++i)
        s[i] += (lambda * std::log(j) - mu) / j;
    }
  else
    {
      // Stretch without spin in one step: the gradient at its middle is (F-1) ((F+1)/2)^-1.
      Matrix<dim, double> sum = f, difference = f;
      for (int i = 0; i < dim; ++i)
        {
          sum[i][i] += 1;
          difference[i][i] -= 1;
        }
      Matrix<dim, double> l   = product<dim, double>(difference, adjugate<dim, double>(sum));
      const double        det = determinant<dim, double>(sum);
      s                       = symmetric_part<dim, double>(l);
      for (int c = 0; c < s.size; ++c)
        s[c] *= 2 * 2 * mu / det;
      for (int i = 0; i < 3; ++i)
        s[i] += 2 * lambda * trace<dim, double>(l) / det;
    }
  return s;
}

/// A rotation by 50 degrees, about (1, 2, 2) / 3 in 3-D.
template <int dim>
dealii::Tensor<1, dim>
turned(const dealii::Tensor<1, dim> &x)
{
  const double angle = 50. / 180. * dealii::numbers::PI;
  if constexpr (dim == 2)
    return dealii::Tensor<1, 2>({std::cos(angle) * x[0] - std::sin(angle) * x[1],
                                 std::sin(angle) * x[0] + std::cos(angle) * x[1]});
  else
    {
      const dealii::Tensor<1, 3> axis({1. / 3., 2. / 3., 2. / 3.});
      return std::cos(angle) * x + std::sin(angle) * dealii::cross_product_3d(axis, x) +
             (1 - std::cos(angle)) * (axis * x) * axis;
    }
}

template <int dim>
void
test(const std::string &integration, const std::string &model, const std::string &mesh)
{
  Matrix<dim, double> f = identity<dim, double>();
  f[0][0] += 0.1;
  f[1][1] -= 0.05;
  f[0][1] += 0.04;
  f[1][0] += 0.04;
  if (dim == 3)
    {
      f[2][2] += 0.03;
      f[0][2] += 0.02;
      f[2][0] += 0.02;
    }
  const auto stretch = [&](const dealii::Tensor<1, dim> &x) {
    dealii::Tensor<1, dim> y;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        y[i] += f[i][j] * x[j];
    return y;
  };
  const BodyCase               body_case(text(integration, model, mesh), dim);
  const Symmetric<dim, double> exact = exact_stress<dim>(f, model == "neo-Hookean");

  const auto body = body_case.solid<dim>();
  move_by(*body, stretch);
  const auto forces = largest_forces(*body);
  deallog << dim << "-D " << integration << ", " << model << ": stress exact "
          << (worst_stress_error(*body, exact) < 1e-9 * mu) << ", no force inside "
          << (forces[0] < 1e-12 * forces[1]);

  move_by(*body, turned<dim>);
  Symmetric<dim, double>                  exact_turned = exact;
  std::array<dealii::Tensor<1, dim>, dim> r;
  for (int j = 0; j < dim; ++j)
    {
      dealii::Tensor<1, dim> unit;
      unit[j] = 1;
      r[j]    = turned<dim>(unit);
    }
  for (int i = 0; i < dim; ++i)
    for (int k = i; k < dim; ++k)
      {
        exact_turned(i, k) = 0;
        for (int a = 0; a < dim; ++a)
          for (int b = 0; b < dim; ++b)
            exact_turned(i, k) += r[a][i] * exact(a, b) * r[b][k];
      }
  deallog << ", turned with the body " << (worst_stress_error(*body, exact_turned) < 1e-9 * mu);

  const auto rigid = body_case.solid<dim>();
  move_by(*rigid, turned<dim>);
  deallog << ", none from a rotation "
          << (worst_stress_error(*rigid, Symmetric<dim, double>()) < 1e-9 * mu &&
              largest_forces(*rigid)[1] < 1e-10 * mu && rigid->energies().hourglass < 1e-15 * mu)
          << std::endl;
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();
  for (const char *integration : {"full", "one point"})
    for (const char *model : {"linear elastic", "neo-Hookean"})
      {
        test<2>(integration, model, "set Type = ball\nset Refinements = 2");
        test<3>(integration, model, "set Type = ball\nset Refinements = 1\nset Position = 1, 2, 3");
      }
}
