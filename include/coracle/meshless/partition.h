// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/columns.h>
#include <coracle/meshless/point_cloud.h>

#include <mpi.h>

namespace coracle::meshless
{
/**
 * Which rank should have each own point, so that all have about as much work
 * and few neighbours: recursive bisection of space by planes (Zoltan's RCB).
 * Does not look at copies. Collective; ranks may be without points.
 *
 * @param weight of each own point: the work it makes, in any unit
 *
 * Source: Boman and others (2012), The Zoltan and Isorropia parallel toolkits.
 */
template <int dim>
std::vector<unsigned int>
partition(const PointCloud<dim> &points, const std::vector<double> &weight, const MPI_Comm comm);

/// Largest share of the weight over the mean share of a rank: 1 if all have the same. Collective.
double imbalance(const std::vector<double> &weight, const MPI_Comm comm);

/**
 * Own points go to the ranks named for them and take their rows of further
 * columns with them; those that a rank then owns are ordered along a
 * space-filling curve, so that neighbours in space are near in memory. Copies
 * are forgotten. Collective.
 *
 * @param destination rank for each own point
 * @param columns     one row per own point (further rows are dropped)
 */
template <int dim>
void migrate(PointCloud<dim>                 &points,
             Columns                         &columns,
             const std::vector<unsigned int> &destination,
             const MPI_Comm                   comm);
} // namespace coracle::meshless
