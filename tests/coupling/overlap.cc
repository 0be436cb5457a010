// SPDX-License-Identifier: GPL-3.0-or-later
// Contact/Initial overlap = project: particles that start too near to a plate, in the corner of two
// walls, in a wedge, on either side of a sheet, or deep inside a body are moved to the contact
// distance and not farther than needed; nothing but positions changes; where there is no room the
// error names them.
#include "coupling/case.h"

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

std::string
text(const std::string &box, const std::string &body, const bool project)
{
  return "subsection Grid\n set Upper corner = 1, 1\n set Cell size = 0.1\nend\n"
         "subsection Contact\n set Initial overlap = " +
         std::string(project ? "project" : "refuse") +
         "\nend\nsubsection Materials\n subsection water\n set Model = weakly compressible\n"
         " set Sound speed = 20\n end\nend\nsubsection Bodies\n subsection water\n set Material = "
         "water\n set Particle spacing = 0.05\n set Initial velocity function = x; y*y\n"
         " set Initial pressure = 100*x\n" +
         box + " end\n" + body + "end\n";
}

std::string
sheet(const std::string &points, const std::string &lines = "")
{
  return " subsection sheet\n set Kind = rigid\n set Mass = 1\n set Free directions = none\n"
         " set Thickness = 0.01\n subsection Mesh\n set Type = polyline\n set Points = " +
         points + "\n set Subdivisions = 2\n" + lines + " end\n end\n";
}

std::string
block(const std::string &corners)
{
  const auto middle = corners.find(" : ");
  return " set Lower corner = " + corners.substr(0, middle) +
         "\n set Upper corner = " + corners.substr(middle + 3) + "\n";
}

void
report(const std::string &title, const std::string &box, const std::string &body)
{
  using Layout = ParticleLayout<2>;
  std::string n_refused;
  try
    {
      make_coupling<2>(text(box, body, false));
    }
  catch (const UserError &error)
    {
      n_refused = error.found.substr(0, error.found.find(" of"));
    }
  std::unique_ptr<Coupling<2>> coupling;
  try
    {
      coupling = make_coupling<2>(text(box, body, true));
    }
  catch (const UserError &error)
    {
      deallog << title << ": refused " << n_refused << "; " << error.title << ": "
              << error.found.substr(0, error.found.find(" at ")) << std::endl;
      return;
    }
  // What a particle had where the lattice put it: v = (x0, y0^2), p = 100 x0.
  const auto  &points   = coupling->points.bodies.front().points;
  bool         same     = true;
  double       farthest = 0;
  unsigned int n_moved  = 0;
  for (std::size_t row = 0; row < points.n_rows(); ++row)
    if (!points.is_hole(row))
      {
        const dealii::Point<2> start(points.column(Layout::velocity)[row],
                                     std::sqrt(points.column(Layout::velocity + 1)[row]));
        const double           way = start.distance(points.position(row));
        n_moved += way > 1e-9;
        farthest = std::max(farthest, way);
        same     = same && std::fabs(points.column(Layout::density)[row] -
                                 (1000 + 100 * start[0] / 400)) < 1e-6;
      }
  n_moved  = mpi::sum(n_moved, comm);
  farthest = mpi::max(farthest, comm);
  deallog << title << ": refused " << n_refused << ", moved " << coupling->projected.n_particles
          << " and no others " << (n_moved == coupling->projected.n_particles) << ", by up to "
          << farthest << ", as said " << (std::fabs(farthest - coupling->projected.farthest) < 1e-9)
          << ", states kept " << !mpi::any(!same, comm) << ", particles "
          << mpi::sum<std::uint64_t>(coupling->points.n_particles(), comm) << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  // R = 0.005 + 0.025. The lowest row is at 0.325: 5 mm too low over a sheet at 0.3.
  const std::string water = block("0.3, 0.3 : 0.5, 0.5");
  report("plate", water, sheet("0, 0.3, 1, 0.3"));
  // Both walls 10 mm into the block: 15 mm along each, in the corner 15 sqrt(2).
  report("corner", water, sheet("0.31, 1, 0.31, 0.31, 1, 0.31"));
  // The lowest particle is 10 mm above the tip of a wedge of 2 * 26.57 degrees: R / sin is out.
  report("wedge", block("0.475, 0.285 : 0.525, 0.335"), sheet("0.25, 0.8, 0.5, 0.3, 0.75, 0.8"));
  report("both faces", block("0.1, 0.1 : 0.9, 0.9"), sheet("-0.1, 0.51, 1.1, 0.51"));
  report("free end", block("0.1, 0.1 : 0.9, 0.9"), sheet("-0.1, 0.51, 0.41, 0.51"));
  // From the middle of a body of 0.3 m, over more than one cell.
  report("deep",
         block("0.1, 0.1 : 0.9, 0.9"),
         " subsection box\n set Kind = rigid\n set Mass = 1\n set Free directions = none\n"
         " subsection Mesh\n set Lower corner = 0.3, 0.35\n set Upper corner = 0.6, 0.65\n"
         " set Subdivisions = 3\n end\n end\n");
  // Two plates with 40 mm between them have no room for particles of 2 R = 60 mm.
  report("no room",
         block("0.3, 0.3 : 0.5, 0.35"),
         sheet("-0.1, 0.305, 1.1, 0.305",
               " subsection Further lines\n subsection top\n set Points = -0.1, 0.345, 1.1, "
               "0.345\n end\n end\n"));
}
