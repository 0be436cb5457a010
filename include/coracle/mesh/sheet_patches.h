// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/mesh/sheet_generation.h>

namespace coracle
{
/**
 * The sheets that a surface consists of: facets joined where two of them meet
 * at an edge (in 2-D: at a point), so that each sheet has two faces which can be
 * told apart. Where more than two facets meet, those that continue each other
 * most straightly are joined first: the flange of a T is one sheet, its web
 * another that ends there.
 *
 * Facets are turned so that all of a sheet have the same orientation as its
 * first one.
 *
 * @return number of its sheet for each facet, from 0 in the order of their first facets
 *
 * Throws std::invalid_argument with the place where a sheet has only one face (a Moebius strip).
 */
template <int dim>
std::vector<unsigned int> join_sheets(FacetList<dim> &surface);
} // namespace coracle
