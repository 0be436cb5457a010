// SPDX-License-Identifier: GPL-3.0-or-later
// Contact on the grid: the law sticks, slips and never adds energy; blocks of particles in
// different fields bounce instead of passing, over hanging nodes; a structure of the cells' size
// stops a block; momentum is kept to round-off, on any number of ranks alike.
#include <random>

#include "coupling/case.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

template <int dim>
void
test_law()
{
  using Vector = dealii::Tensor<1, dim>;
  std::mt19937                     generator(5);
  std::uniform_real_distribution<> number(-1, 1);
  bool     no_gain = true, no_pull = true, in_cone = true, sticks = true, slips = true;
  unsigned n_sticking = 0, n_slipping = 0, n_apart = 0;
  for (unsigned int i = 0; i < 20000; ++i)
    {
      GridContactSide<dim> r, s;
      Vector               normal;
      // Masses alike in all directions, then directions fixed at random.
      const double mass_r = std::pow(10, 3 * number(generator)),
                   mass_s = std::pow(10, 3 * number(generator));
      for (int d = 0; d < dim; ++d)
        {
          r.velocity[d]     = number(generator);
          s.velocity[d]     = number(generator);
          normal[d]         = number(generator);
          r.inverse_mass[d] = (i % 2 && number(generator) > 0.5) ? 0 : 1 / mass_r;
          s.inverse_mass[d] = (i % 2 && number(generator) > 0.5) ? 0 : 1 / mass_s;
        }
      normal /= normal.norm();
      const double friction = number(generator) > 0 ? std::fabs(number(generator)) : 0.;
      const Vector p        = grid_contact_impulse(r, s, normal, friction);
      if (p.norm() == 0)
        {
          ++n_apart;
          continue;
        }
      const Vector before = s.velocity - r.velocity;
      Vector       after  = before;
      for (int d = 0; d < dim; ++d)
        after[d] += p[d] * (r.inverse_mass[d] + s.inverse_mass[d]);
      const Vector along = p - (p * normal) * normal;
      no_gain            = no_gain && p * (before + after) <= 1e-12 * p.norm();
      no_pull            = no_pull && p * normal > 0 && before * normal < 0;
      in_cone            = in_cone && along.norm() <= friction * (p * normal) + 1e-12 * p.norm();
      if (i % 2 == 0)
        {
          const bool slipping = after.norm() > 1e-10;
          ++(slipping ? n_slipping : n_sticking);
          if (slipping)
            slips = slips && std::fabs(after * normal) < 1e-10 &&
                    std::fabs(along.norm() - friction * (p * normal)) < 1e-10 * p.norm();
          else
            sticks = sticks && along.norm() <= friction * (p * normal) * (1 + 1e-10);
        }
    }
  deallog << "law: no energy gained " << no_gain << ", never pulls " << no_pull << ", in the cone "
          << in_cone << ", sticks " << (sticks && n_sticking > 100) << ", slips on the cone "
          << (slips && n_slipping > 100) << ", parts " << (n_apart > 100) << std::endl;
}

/// A list of `dim` numbers: x along, across and what is left.
template <int dim>
std::string
place(const double x, const double across)
{
  std::string result = std::to_string(x);
  for (int d = 1; d < dim; ++d)
    result += ", " + std::to_string(across);
  return result;
}

template <int dim>
std::string
block(const std::string &name, const double begin, const double velocity)
{
  return " subsection " + name + "\n set Material = rubber\n set Velocity field = " + name +
         "\n set Particle spacing = 0.05\n set Lower corner = " + place<dim>(begin, 0) +
         "\n set Upper corner = " + place<dim>(begin + 0.2, 0.2) +
         "\n set Initial velocity = " + place<dim>(velocity, 0) +
         "\n set PIC fraction = 0\n set Stress update = usl\n set Shape functions = gimp\n end\n";
}

template <int dim>
std::string
text(const std::string &bodies, const std::string &contact, const double refined)
{
  return "subsection Time\n set Safety factor = 0.1\nend\nsubsection Grid\n set Lower corner = " +
         place<dim>(0, 0) + "\n set Upper corner = " + place<dim>(1.2, 0.2) +
         "\n set Cell size = 0.1\n subsection Refinement\n subsection middle\n set Lower corner "
         "= " +
         place<dim>(refined, 0) + "\n set Upper corner = " + place<dim>(refined + 0.1, 0.1) +
         "\n set Level = 1\n end\n end\nend\n"
         "subsection Materials\n subsection rubber\n set Model = neo-Hookean\n set Density = 1000\n"
         " set Young modulus = 1e4\n set Poisson ratio = 0\n end\nend\n"
         "subsection Bodies\n" +
         bodies + "end\nsubsection Contact\n" + contact + "end\n";
}

/// Furthest and nearest particle of a body along x, over all ranks.
template <int dim>
std::pair<double, double>
extent(const MaterialPoints<dim> &points)
{
  double first = 1e300, last = -1e300;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    if (!points.is_hole(row))
      {
        first = std::min(first, points.position(row)[0]);
        last  = std::max(last, points.position(row)[0]);
      }
  return {mpi::min(first, comm), mpi::max(last, comm)};
}

template <int dim>
void
test_fields(const bool meet)
{
  const auto coupling = make_coupling<dim>(
    text<dim>(block<dim>("left", 0.2, 0.5) + block<dim>("right", 0.55, -0.5),
              meet ? " set Between fields = grid\n set Friction between fields = 0.3\n" : "",
              0.5));
  const auto  &left = coupling->points.bodies.front(), &right = coupling->points.bodies.back();
  const double mass = Totals<dim>(left.points).mass, start = energy_balance(*coupling);
  double       momentum = 0, gap = 1e300, books = 0, balance = 0;
  unsigned int touching = 0;
  while (coupling->time() < 0.5 - 1e-9)
    {
      coupling->advance(0.5);
      momentum = std::max(momentum,
                          std::fabs(Totals<dim>(left.points).momentum[0] +
                                    Totals<dim>(right.points).momentum[0]));
      gap      = std::min(gap, extent(right.points).first - extent(left.points).second);
      touching += coupling->contacts.report().n_contacts > 0;
      if (meet)
        {
          const auto &received = coupling->contacts.contact_momentum();
          books = std::max(books, mpi::sum(received[0], comm)[0] + mpi::sum(received[1], comm)[0]);
          // To first order in the step: half the step, half the error.
          balance = std::max(balance, energy_balance(*coupling) - start);
        }
    }
  const double v = Totals<dim>(left.points).momentum[0] / mass;
  deallog << "fields that " << (meet ? "meet" : "do not meet") << ": touched " << (touching > 10)
          << ", apart " << (gap > 0.02) << ", turned round " << (v < -0.1) << ", momentum kept "
          << (momentum < 1e-12 * mass) << ", books of both agree " << (books < 1e-12 * mass)
          << ", books of energy close to 5 % " << (balance < 0.05 * 0.25 * mass) << std::endl;
  deallog << "velocity of the left one " << v << std::endl;
}

/// A block against a plate of elements or a rigid one with nodes as far apart as the grid's.
template <int dim>
void
test_structure(const std::string &plate, const bool is_free)
{
  const auto coupling = make_coupling<dim>(
    text<dim>(block<dim>("left", 0.2, 0.5) + " subsection plate\n" + plate +
                " subsection Mesh\n set Type = box\n set Subdivisions = " +
                (dim == 2 ? "4, 2" : "4, 2, 2") + "\n set Lower corner = " + place<dim>(0.5, 0) +
                "\n set Upper corner = " + place<dim>(0.9, 0.2) + "\n end\n end\n",
              " set Method = grid\n",
              0.2));
  const auto       &left = coupling->points.bodies.front();
  const Totals<dim> start(left.points);
  double            momentum = 0, books = 0, nearest = 0;
  const auto        structure = [&] {
    return coupling->structure.rigids.empty() ? coupling->structure.solids.front().summary()
                                                     : coupling->structure.rigids.front().summary();
  };
  while (coupling->time() < 0.6 - 1e-9)
    {
      coupling->advance(0.6);
      const double now      = Totals<dim>(left.points).momentum[0],
                   own      = structure().mass * structure().velocity[0];
      momentum              = std::max(momentum, std::fabs(now + own - start.momentum[0]));
      const auto  &received = coupling->contacts.contact_momentum();
      const double given    = mpi::sum(coupling->structure.contact_momentum()[0][0], comm);
      books                 = std::max(books, std::fabs(mpi::sum(received[0][0], comm) + given));
      nearest = std::max(nearest, extent(left.points).second - structure().centre[0] + 0.2);
    }
  const double v = Totals<dim>(left.points).momentum[0] / start.mass;
  deallog << (coupling->structure.rigids.empty() ? "elements: " : "rigid: ") << "penetrations "
          << mpi::max(coupling->contacts.n_penetrations(), comm) << ", parted again "
          << (v < structure().velocity[0] - 0.1) << ", came near " << (nearest > -0.06)
          << ", books agree " << (books < 1e-12 * start.mass);
  if (is_free)
    deallog << ", momentum kept " << (momentum < 1e-12 * start.mass);
  deallog << std::endl << "velocity of the block " << v << std::endl;
}

template <int dim>
void
test()
{
  test_law<dim>();
  test_fields<dim>(true);
  if (dim == 2)
    test_fields<dim>(false);
  test_structure<dim>(" set Kind = solid\n set Material = rubber\n", true);
  test_structure<dim>(" set Kind = rigid\n set Mass = 100\n set Free directions = x\n", true);
  if (dim == 2)
    test_structure<dim>(" set Kind = rigid\n set Mass = 1\n set Free directions = none\n", false);
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  deallog.push("2d");
  test<2>();
  deallog.pop();
  deallog.push("3d");
  test<3>();
  deallog.pop();
}
