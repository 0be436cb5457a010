// SPDX-License-Identifier: GPL-3.0-or-later
// Water under one pressure everywhere, enclosed by plates that stand inside cells, stays at rest to
// the last digits of the contact solver if the half of a particle at a plate is rigid, and begins
// to move if it is not; in corners of two plates too, and where ranks meet.
#include "coupling/case.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

/// A tight box of plates around water of 0.2 m x 0.2 m, in 3-D between two faces of the grid's box.
std::string
enclosed_water(const int dim, const bool rigid_half)
{
  const bool         flat = dim == 2;
  std::ostringstream text;
  text << "subsection Grid\n set Lower corner = 0, 0" << (flat ? "" : ", 0")
       << "\n set Upper corner = 0.4, 0.4" << (flat ? "" : ", 0.1")
       << "\n set Cell size = 0.05\nend\n"
          "subsection Contact\n set Tolerance = 1e-12\n set "
          "Initial overlap = project\n"
          " set Rigid half = "
       << (rigid_half ? "true" : "false")
       << "\nend\n"
          "subsection Materials\n subsection water\n set Model = weakly compressible\n"
          " set Sound speed = 50\n end\nend\n"
          "subsection Bodies\n subsection water\n set Material = water\n"
          " set Particle spacing = 0.0125\n set Shape functions = gimp\n"
          " set Lower corner = 0.12, 0.12"
       << (flat ? "" : ", 0") << "\n set Upper corner = 0.32, 0.32" << (flat ? "" : ", 0.1")
       << "\n set Initial pressure = 1e4\n end\n"
          " subsection plates\n set Kind = rigid\n set Mass = 1\n set Free directions = none\n"
          " set Thickness = 1 mm\n subsection Mesh\n set Type = polyline\n"
          " set Points = 0.1195, 0.1195, 0.3205, 0.1195, 0.3205, 0.3205, 0.1195, 0.3205, 0.1195, "
          "0.1195\n"
          " set Subdivisions = 4\n set Length = 0.3\n set Subdivisions along z = 3\n"
          " set Position = 0, 0"
       << (flat ? "" : ", -0.1") << "\n end\n end\nend\n";
  return text.str();
}

/// Speed of the fastest particle over that of a particle's mass under its own pressure, after some
/// steps.
template <int dim>
double
restlessness(const bool rigid_half)
{
  using Layout                 = ParticleLayout<dim>;
  const auto         coupling  = make_coupling<dim>(enclosed_water(dim, rigid_half));
  const unsigned int n_steps   = 10;
  double             allowance = 0, speed = 0;
  for (unsigned int i = 0; i < n_steps; ++i)
    {
      coupling->advance(1e300);
      allowance += coupling->last_step() * 1e4 / (1000 * 0.0125);
    }
  const auto &points = coupling->points.bodies.front().points;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    if (!points.is_hole(row))
      for (int d = 0; d < dim; ++d)
        speed = std::max(speed, std::fabs(points.column(Layout::velocity + d)[row]));
  return mpi::max(speed, comm) / allowance;
}

template <int dim>
void
test()
{
  const double at_rest = restlessness<dim>(true), moving = restlessness<dim>(false);
  deallog << dim << "-D: at rest " << (at_rest < 1e-9) << ", without the rigid half not "
          << (moving > 1e-3) << std::endl;
  if (at_rest >= 1e-9 || moving <= 1e-3)
    deallog << at_rest << ' ' << moving << std::endl;
}

int
main(int argc, char *argv[])
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  deallog << std::boolalpha;
  test<2>();
  test<3>();
}
