// SPDX-License-Identifier: GPL-3.0-or-later
// Thin rigid sheets: water that swirls in the four quarters of two crossed sheets stays in its
// quarter, whichever rank it is on, and each of its particles near a sheet knows its side; a free
// sheet between two blocks of water takes what momentum they lose.
#include "coupling/case.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

std::string
corners(const double x0, const double y0, const double x1, const double y1, const int dim)
{
  std::ostringstream text;
  const bool         flat = dim == 2;
  text << " set Lower corner = " << x0 << ", " << y0 << (flat ? "" : ", 0")
       << "\n set Upper corner = " << x1 << ", " << y1 << (flat ? "\n" : ", 0.1\n");
  return text.str();
}

/// A box of 0.4 m, 0.1 m deep in 3-D.
std::string
frame(const int dim)
{
  return "subsection Grid\n" + corners(0, 0, 0.4, 0.4, dim) +
         " set Cell size = 0.05\nend\nsubsection Materials\n subsection water\n set Model = weakly "
         "compressible\n set Sound speed = 40\n end\nend\n";
}

std::string
water(const std::string &name, const std::string &lines)
{
  return " subsection " + name +
         "\n set Material = water\n set Particle spacing = 0.025\n set Contact radius = 0.1\n" +
         lines + " end\n";
}

/// Are a quarter's particles in it, and do those near a sheet know on which side of it they are?
template <int dim>
void
look(const MaterialPoints<dim> &points,
     const unsigned int         quarter,
     bool                      &stays,
     bool                      &knows,
     unsigned int              &n_near)
{
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    if (!points.is_hole(row))
      {
        const auto x = points.position(row);
        stays = stays && (x[0] > 0.2) == (quarter >= 2) && (x[1] > 0.2) == (quarter % 2 == 1);
        // The first sheet is the one along x, its outside below; the other's is on the right.
        const std::array<double, 2> side     = {{x[1] > 0.2 ? -1. : 1., x[0] > 0.2 ? 1. : -1.}},
                                    distance = {{std::fabs(x[1] - 0.2), std::fabs(x[0] - 0.2)}};
        for (int sheet = 0; sheet < 2; ++sheet)
          if (distance[sheet] < 0.0035)
            {
              ++n_near;
              knows = knows && points.column(points.layout().side + sheet)[row] == side[sheet];
            }
      }
}

template <int dim>
void
test_cross()
{
  std::string bodies;
  for (const int x : {0, 1})
    for (const int y : {0, 1})
      {
        const std::string name = "water" + std::to_string(2 * x + y);
        bodies +=
          water(name,
                corners(0.05 + 0.2 * x, 0.05 + 0.2 * y, 0.15 + 0.2 * x, 0.15 + 0.2 * y, dim) +
                  " set Initial velocity function = 20*(0.2-y); 20*(x-0.2)" +
                  (dim == 3 ? "; 0\n" : "\n"));
      }
  const auto coupling = make_coupling<dim>(
    frame(dim) + "subsection Bodies\n" + bodies +
    " subsection cross\n set Kind = rigid\n set Mass = 1\n set Free directions = none\n"
    " set Thickness = 1 mm\n subsection Mesh\n set Type = polyline\n"
    " set Points = -0.1, 0.2, 0.2, 0.2, 0.2, 0.5\n set Subdivisions = 3\n"
    " set Length = 0.3\n set Subdivisions along z = 3\n set Position = 0, 0" +
    (dim == 3 ? ", -0.1\n" : "\n") +
    " subsection Further lines\n subsection rest\n set Points = 0.5, 0.2, 0.2, 0.2, 0.2, -0.1\n"
    " set Subdivisions = 2\n end\n end\n end\n end\nend\n");

  bool         stays = true, knows = true;
  unsigned int touching = 0, n_near = 0;
  for (unsigned int i = 0; i < 120; ++i)
    {
      coupling->advance(1e300);
      touching += coupling->contacts.report().n_contacts > 0;
      unsigned int quarter = 0;
      for (const auto &body : coupling->points.bodies)
        look<dim>(body.points, quarter++, stays, knows, n_near);
    }
  deallog << "crossed sheets: " << coupling->structure.n_sheets() << ", penetrations "
          << mpi::max(coupling->contacts.n_penetrations(), comm) << ", all stay "
          << !mpi::any(!stays, comm) << ", touched " << (touching > 50) << ", sides known "
          << !mpi::any(!knows, comm) << " where near " << (mpi::sum(n_near, comm) > 100)
          << ", ledger " << coupling->points.ledger_error() << std::endl;
}

template <int dim>
void
test_free_sheet()
{
  // From above faster than from below.
  const std::string y        = dim == 2 ? "" : ", 0";
  const auto        coupling = make_coupling<dim>(
    frame(dim) + "subsection Bodies\n" +
    water("above",
          corners(0.1, 0.205, 0.3, 0.305, dim) + " set Initial velocity = 0, -3" + y + "\n") +
    water("below",
          corners(0.1, 0.095, 0.3, 0.195, dim) +
            " set Velocity field = low\n set Initial velocity = 0, 1" + y + "\n") +
    " subsection sheet\n set Kind = rigid\n set Density = 7800\n"
           " set Thickness = 1 mm\n set Free directions = y\n subsection Mesh\n"
           " set Type = polyline\n set Points = 0, 0.2, 0.4, 0.2\n"
           " set Subdivisions = 7\n set Length = 0.1\n end\n end\nend\n");
  const auto &sheet    = coupling->structure.rigids.front();
  const auto  momentum = [&] {
    double sum = sheet.mass() * sheet.centre_velocity()[1];
    for (const auto &body : coupling->points.bodies)
      sum += Totals<dim>(body.points).momentum[1];
    return sum;
  };
  const double start = momentum();
  double       worst = 0;
  for (unsigned int i = 0; i < 15; ++i)
    {
      coupling->advance(1e300);
      worst = std::max(worst, std::fabs(momentum() - start));
    }
  deallog << "free sheet: mass right "
          << (std::fabs(sheet.mass() / (dim == 2 ? 3.12 : 0.312) - 1) < 1e-12) << ", momentum kept "
          << (worst < 1e-12 * std::fabs(start)) << ", was pushed down "
          << (sheet.centre_velocity()[1] < -0.1) << ", penetrations "
          << mpi::max(coupling->contacts.n_penetrations(), comm) << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  deallog.push("2d");
  test_cross<2>();
  test_free_sheet<2>();
  deallog.pop();
  deallog.push("3d");
  test_cross<3>();
  test_free_sheet<3>();
  deallog.pop();
}
