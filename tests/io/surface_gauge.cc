// SPDX-License-Identifier: GPL-3.0-or-later
// A gauge at a slanted surface of a meshless fluid reads its height to round-off, wherever it
// stands between points, whichever way gravity acts, in the plane and in space, and on any number
// of ranks.
#include <coracle/io/surface_gauge.h>

#include "../meshless/tank.h"
#include <filesystem>
#include <fstream>

using namespace coracle;

const MPI_Comm comm = MPI_COMM_WORLD;

/// The last row's value of a column.
double
last_value(const std::string &file, const std::string &column)
{
  std::ifstream stream(file);
  std::string   names, row, line, name, value;
  std::getline(stream, names);
  while (std::getline(stream, line))
    row = line;
  std::istringstream all_names(names), all_values(row);
  while (std::getline(all_names, name, ','))
    {
      std::getline(all_values, value, ',');
      if (name.find(column) != std::string::npos)
        return std::stod(value);
    }
  return -1e300;
}

/// Fluid for x_across < 0.8 (the first axis that is not up), below 0.5 + 0.1 x_across.
template <int dim>
void
test(const unsigned int up, const double sign)
{
  const unsigned int n = 10, across = up == 0 ? 1 : 0;
  auto               options = tank::box<dim>(n);
  options.gravity            = dealii::Tensor<1, dim>();
  options.gravity[up]        = -10 * sign;
  meshless::Fluid<dim>          fluid("water", options, comm);
  dealii::Point<dim>            upper;
  std::array<unsigned int, dim> intervals;
  for (unsigned int d = 0; d < dim; ++d)
    {
      upper[d]     = d == across ? 0.8 : d == up ? 0.5 : 1;
      intervals[d] = std::lround(upper[d] * n);
    }
  unsigned int n_points = 1;
  for (const unsigned int m : intervals)
    n_points *= m + 1;
  for (unsigned int id = mpi::rank(comm); id < n_points; id += mpi::n_ranks(comm))
    {
      dealii::Point<dim> x;
      for (unsigned int d = 0, rest = id; d < dim; rest /= intervals[d] + 1, ++d)
        x[d] = double(rest % (intervals[d] + 1)) / n;
      x[up] *= 1 + 0.2 * x[across];
      if (sign < 0)
        x[up] = 1 - x[up];
      fluid.add_point(x, {}, id);
    }
  fluid.remesh();

  ProbeDescription<dim> place;
  place.name = "gauge";
  place.body = "water";
  for (const double at : {0.3, 0.4321, 0.8, 0.95})
    {
      place.position         = dealii::Point<dim>();
      place.position[across] = at;
      if (dim == 3)
        place.position[3 - up - across] = 0.777;
      const std::string file = "gauge.csv";
      {
        Statistics statistics(file, comm);
        SurfaceGauge<dim>::add_columns(place, statistics);
        statistics.begin_row();
        SurfaceGauge<dim>(place, comm).set_columns(fluid, statistics);
        statistics.end_row();
      }
      MPI_Barrier(comm);
      const double height = last_value(file, "height"), wet = last_value(file, "wet"),
                   exact = at > 0.8 ? 0 : 0.5 + 0.1 * at;
      deallog << dim << "-D, up " << sign * (up + 1.) << ", at " << at << ": wet " << wet
              << ", height right to 1e-8: "
              << (std::fabs((sign > 0 ? height : 1 - height) - exact) < 1e-8) << std::endl;
      MPI_Barrier(comm);
    }
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  test<2>(1, 1);
  test<2>(1, -1);
  test<2>(0, 1);
  test<3>(2, 1);
  test<3>(1, 1);
}
