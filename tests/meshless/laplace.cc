// SPDX-License-Identifier: GPL-3.0-or-later
// Laplace shape functions of random polygons and polyhedra on a sphere, of squares, cubes, prisms
// and pyramids, and of bodies that fit their sphere only within a tolerance: partition of unity,
// not negative, linear functions exact, one at their node, linear on facets, gradients as finite
// differences; (bi-, tri-)linear on simplices and boxes.
#include <coracle/meshless/laplace.h>

#include "clouds.h"

using namespace clouds;
using dealii::Point;
using dealii::Tensor;

template <int dim>
Point<dim>
on_sphere(std::mt19937_64 &engine)
{
  Tensor<1, dim> x;
  for (unsigned int d = 0; d < dim; ++d)
    x[d] = std::normal_distribution<>()(engine);
  return Point<dim>(x / x.norm());
}

/// One element from all points, or nothing if they are too few.
template <int dim>
Tessellation<dim>
one_element(const PointCloud<dim> &cloud, const double tolerance = 1e-6)
{
  auto t = tessellate(cloud, {1e3, tolerance}, MPI_COMM_SELF);
  if (t.n_elements() != 1)
    deallog << "not one element but " << t.n_elements() << std::endl;
  return t;
}

/// What must hold in any element.
template <int dim>
void
properties(const std::string       &name,
           const PointCloud<dim>   &cloud,
           const Tessellation<dim> &t,
           const bool               on_spheres = true)
{
  LaplaceShape<dim> shape;
  double            unity = 0., linear = 0., volume = 0., least = 0., differences = 0.;
  for (unsigned int e = 0; e < t.n_elements(); ++e)
    {
      shape.reinit(cloud, t, e);
      const unsigned int n              = shape.n_nodes();
      double             sum_of_weights = 0.;
      for (unsigned int q = 0; q < shape.n_points(); ++q)
        {
          sum_of_weights += shape.weight(q);
          double         sum = -1.;
          Tensor<1, dim> at, sum_gradient;
          Tensor<2, dim> jacobian;
          for (unsigned int i = 0; i < n; ++i)
            {
              const auto &x = cloud.position[t.node[t.first_node[e] + i]];
              sum += shape.value(q, i);
              least = std::min(least, shape.value(q, i));
              at += shape.value(q, i) * x;
              sum_gradient += shape.gradient(q, i);
              jacobian += outer_product(x, shape.gradient(q, i));
            }
          for (unsigned int d = 0; d < dim; ++d)
            jacobian[d][d] -= 1.;
          double steepest = 1.;
          for (unsigned int i = 0; i < n; ++i)
            steepest = std::max(steepest, shape.gradient(q, i).norm());
          unity  = std::max({unity, std::abs(sum), sum_gradient.norm() / steepest});
          linear = std::max({linear, (at - shape.point(q)).norm(), jacobian.norm() / steepest});
        }
      volume = std::max(volume, std::abs(sum_of_weights - t.volume[e]));
      if (n == dim + 1)
        continue;
      // Gradients by central differences.
      std::vector<double>         plus(n), minus(n);
      std::vector<Tensor<1, dim>> gradient(n), unused(n);
      for (unsigned int q = 0; q < shape.n_points(); q += 3)
        for (unsigned int d = 0; d < dim; ++d)
          {
            const Tensor<1, dim> step = 1e-6 * Point<dim>::unit_vector(d);
            shape.evaluate(shape.point(q), plus.data(), gradient.data());
            shape.evaluate(shape.point(q) + step, plus.data(), unused.data());
            shape.evaluate(shape.point(q) - step, minus.data(), unused.data());
            for (unsigned int i = 0; i < n; ++i)
              differences = std::max(differences,
                                     std::abs((plus[i] - minus[i]) / 2e-6 - gradient[i][d]) /
                                       (1. + gradient[i].norm_square()));
          }
    }
  deallog << name << ' ' << dim << "-D: unity " << (unity < 1e-12) << ", linear "
          << (linear < 1e-12) << ", weights " << (volume < (on_spheres ? 1e-12 : 1e-3))
          << ", not negative " << (least > -1e-9 || !on_spheres) << ", gradients "
          << (differences < 1e-6) << std::endl;
}

/// Near a node the node's function is one, near a facet only its nodes count, linearly.
template <int dim>
void
at_the_rim(const std::string &name, const PointCloud<dim> &cloud, const Tessellation<dim> &t)
{
  LaplaceShape<dim> shape;
  shape.reinit(cloud, t, 0);
  const unsigned int          n = shape.n_nodes();
  std::vector<double>         value(n);
  std::vector<Tensor<1, dim>> gradient(n);
  Tensor<1, dim>              middle;
  for (unsigned int i = 0; i < n; ++i)
    middle += cloud.position[t.node[i]] / n;
  double node = 0., facet = 0.;
  for (unsigned int i = 0; i < n; ++i)
    {
      const auto &x = cloud.position[t.node[i]];
      shape.evaluate(Point<dim>(x + 1e-9 * (middle - x)), value.data(), gradient.data());
      node = std::max(node, std::abs(value[i] - 1.));
    }
  for (const auto &f : t.facet)
    {
      Tensor<1, dim>      x;
      std::vector<double> share(n);
      for (unsigned int k = 0; k < dim; ++k)
        {
          const double s = 2. * (k + 1) / (dim * (dim + 1));
          x += s * cloud.position[f[k]];
          share[std::find(t.node.begin(), t.node.end(), f[k]) - t.node.begin()] = s;
        }
      shape.evaluate(Point<dim>(x + 1e-9 * (middle - x)), value.data(), gradient.data());
      for (unsigned int i = 0; i < n; ++i)
        facet = std::max(facet, std::abs(value[i] - share[i]));
    }
  deallog << name << ' ' << dim << "-D: one at its node " << (node < 1e-6) << ", linear on facets "
          << (facet < 1e-6) << std::endl;
}

template <int dim>
PointCloud<dim>
random_on_sphere(const unsigned int n, std::mt19937_64 &engine)
{
  PointCloud<dim> cloud;
  while (cloud.size() < n)
    {
      const auto p    = on_sphere<dim>(engine);
      bool       near = false;
      for (const auto &other : cloud.position)
        near = near || other.distance(p) < (dim == 2 ? 2. / n : 1. / std::sqrt(n));
      if (!near)
        add(cloud, p, 1.);
    }
  return cloud;
}

template <int dim>
void
bodies_on_a_sphere()
{
  std::mt19937_64 engine(3);
  for (const unsigned int n : {dim + 2, dim + 4, 12, 25})
    {
      auto cloud = random_on_sphere<dim>(n, engine);
      properties("sphere of " + std::to_string(n), cloud, one_element(cloud));
      at_the_rim("sphere of " + std::to_string(n), cloud, one_element(cloud));
      perturb(cloud, 1e-5, n);
      properties("rough sphere", cloud, one_element(cloud, 0.01), false);
      at_the_rim("rough sphere", cloud, one_element(cloud, 0.01));
    }
}

/// In a box of any shape N is a product of linear functions.
template <int dim>
void
box()
{
  PointCloud<dim> cloud = grid<dim>(2, 1.);
  for (auto &p : cloud.position)
    for (unsigned int d = 0; d < dim; ++d)
      p[d] *= 1. + 0.7 * d;
  const auto        t = one_element(cloud);
  LaplaceShape<dim> shape;
  shape.reinit(cloud, t, 0);
  double worst = 0.;
  for (unsigned int q = 0; q < shape.n_points(); ++q)
    for (unsigned int i = 0; i < shape.n_nodes(); ++i)
      {
        double product = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double s = shape.point(q)[d] / (1. + 0.7 * d);
            product *= cloud.position[t.node[i]][d] > 0.5 ? s : 1. - s;
          }
        worst = std::max(worst, std::abs(product - shape.value(q, i)));
      }
  deallog << "box " << dim << "-D: product of linear functions " << (worst < 1e-12) << std::endl;
  properties("box", cloud, t);
}

void
prism_and_pyramid()
{
  PointCloud<3> prism, pyramid;
  for (const double z : {0., 1.})
    for (const auto &[x, y] : {std::pair{0., 0.}, {1., 0.}, {0.2, 0.9}})
      add(prism, {x, y, z}, 1.);
  for (const auto &[x, y] : {std::pair{0., 0.}, {1., 0.}, {1., 1.}, {0., 1.}})
    add(pyramid, {x, y, 0.}, 1.);
  add(pyramid, {0.5, 0.5, 0.8}, 1.);
  properties("prism", prism, one_element(prism));
  properties("pyramid", pyramid, one_element(pyramid));
}

/// Integrals of gradients over the elements around a point inside cancel, however elements are
/// merged.
template <int dim>
void
consistent(const std::string     &name,
           const PointCloud<dim> &cloud,
           const double           tolerance,
           const double           bound = 1e-11)
{
  const auto                  t = tessellate(cloud, {1.5, tolerance}, MPI_COMM_SELF);
  std::vector<Tensor<1, dim>> sum(cloud.size());
  LaplaceShape<dim>           shape;
  unsigned int                polytopes = 0, inside = 0;
  for (unsigned int e = 0; e < t.n_elements(); ++e)
    {
      shape.reinit(cloud, t, e);
      polytopes += !t.is_simplex(e);
      for (unsigned int q = 0; q < shape.n_points(); ++q)
        for (unsigned int i = 0; i < shape.n_nodes(); ++i)
          sum[t.node[t.first_node[e] + i]] += shape.weight(q) * shape.gradient(q, i);
    }
  double worst = 0.;
  for (unsigned int i = 0; i < cloud.size(); ++i)
    if (!t.on_free_surface[i])
      {
        worst = std::max(worst, sum[i].norm() / std::pow(cloud.spacing[i], dim - 1));
        ++inside;
      }
  deallog << name << ' ' << dim << "-D: merged " << (polytopes > t.n_elements() / 100)
          << ", points inside " << (inside > cloud.size() / 4) << ", forces cancel "
          << (worst < bound) << std::endl;
}

template <int dim>
void
forces_of_constant_pressure()
{
  auto cloud = grid<dim>(dim == 2 ? 12 : 7, 0.1);
  consistent("rows", cloud, 1e-6);
  perturb(cloud, 1e-12, 1);
  consistent("rows, round-off", cloud, 1e-6);
  // Rows here, flow there: squares beside triangles, cubes beside pyramids.
  for (auto &p : cloud.position)
    if (p[0] > 0.25)
      p[1] += 0.03 * std::sin(30. * p[0] + 20. * p[1]);
  consistent("rows and flow", cloud, 1e-6);
  cloud = grid<dim>(dim == 2 ? 12 : 7, 0.1);
  perturb(cloud, 1e-7, 2);
  consistent("as far as the tolerance", cloud, 1e-6);
  perturb(cloud, 1e-4, 2);
  consistent("bent faces", cloud, 1e-3, dim == 2 ? 1e-11 : 1e-6);
  perturb(cloud, 1e-2, 2);
  consistent("random", cloud, 0.1, dim == 2 ? 1e-11 : 1e-2);
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  initlog();
  bodies_on_a_sphere<2>();
  bodies_on_a_sphere<3>();
  box<2>();
  box<3>();
  prism_and_pyramid();
  forces_of_constant_pressure<2>();
  forces_of_constant_pressure<3>();
  properties("random simplices",
             random<2>(100, 5),
             tessellate(random<2>(100, 5), {}, MPI_COMM_SELF));
  properties("random simplices",
             random<3>(100, 5),
             tessellate(random<3>(100, 5), {}, MPI_COMM_SELF));
}
