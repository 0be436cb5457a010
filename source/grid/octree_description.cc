// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/grid/octree.h>

#include <sstream>

namespace coracle
{
template <int dim>
void
OctreeDescription<dim>::declare(Declaration &grid)
{
  grid.list("Lower corner", "0, 0", "m", "", "Corner of the box with the smallest coordinates.");
  grid.list("Upper corner", "1, 1", "m", "", "Corner of the box with the largest coordinates.");
  grid.quantity(
    "Cell size",
    "0.1",
    "m",
    "h",
    "Edge length of the square or cubic cells before local refinement; the box must be a "
    "whole number of cells.",
    1e-12);
  auto &region =
    grid.named_sections("Refinement",
                        "region",
                        "Boxes in which cells are refined. Neighbours differ by one "
                        "level at most, so cells around a region are refined as well.");
  region.list("Lower corner", "0, 0", "m", "", "Smallest coordinates of the region.");
  region.list("Upper corner", "1, 1", "m", "", "Largest coordinates of the region.");
  region.integer("Level", 1, "Bisections of the base cell inside the region.", 1, 12);
}

template <int dim>
OctreeDescription<dim>
OctreeDescription<dim>::read(const Parameters &grid)
{
  const auto read_box = [](const Parameters &section) {
    const auto lower = section.point<dim>("Lower corner"),
               upper = section.point<dim>("Upper corner");
    for (unsigned int d = 0; d < dim; ++d)
      if (!(upper[d] > lower[d]))
        throw section.error("Upper corner",
                            "a box has no extent",
                            "upper corner " + std::to_string(upper[d]) + " m is not above " +
                              std::to_string(lower[d]) + " m in direction " + "xyz"[d],
                            "give an upper corner that is larger in every direction");
    return dealii::BoundingBox<dim>(std::make_pair(lower, upper));
  };
  OctreeDescription result{read_box(grid), grid.quantity("Cell size"), {}};
  for (unsigned int d = 0; d < dim; ++d)
    {
      const double length = result.box.side_length(d), cells = length / result.cell_size;
      const double whole = std::max(1., std::round(cells));
      if (std::abs(cells - whole) > 1e-6 * whole)
        {
          std::ostringstream found, cure;
          found << length << " m in direction "
                << "xyz"[d] << " are " << cells << " cells of " << result.cell_size << " m";
          cure << "move the upper corner to "
               << result.box.lower_bound(d) + whole * result.cell_size << " m or "
               << result.box.lower_bound(d) + std::ceil(cells) * result.cell_size
               << " m, or set Cell size = " << length / whole << " m";
          throw grid.error("Cell size",
                           "the box is not a whole number of cells",
                           found.str(),
                           cure.str());
        }
      // What was written with few digits becomes a whole number of cells to round-off.
      auto corners      = result.box.get_boundary_points();
      corners.second[d] = corners.first[d] + whole * result.cell_size;
      result.box        = dealii::BoundingBox<dim>(corners);
    }
  const Parameters regions = grid.section("Refinement");
  for (const std::string &name : regions.section_names())
    {
      const Parameters region = regions.section(name);
      result.refinements.push_back(
        {read_box(region), static_cast<unsigned int>(region.integer("Level"))});
    }
  return result;
}

template struct OctreeDescription<2>;
template struct OctreeDescription<3>;
} // namespace coracle
