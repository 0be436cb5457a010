// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/gauss_seidel.h>

namespace coracle::contact
{
/**
 * The contact force of Chen, Qiu, Zhang & Lian (2015), Eqs. 47-52: every contact
 * works out from the predicted velocities, as if it were alone, the impulse that
 * would stop all relative motion; its tangential part is cut to friction times
 * the normal part; all are applied at once, and only once. Contacts that share
 * nodes get too much, or are moved again by their neighbours: kept for
 * comparison with the published method.
 *
 * Masses are those of Song, Liu & Zhang (2020), Eq. 33, for both sides: the
 * paper's particle mass (Eqs. 42-48) does not fit the grid nodes to which the
 * impulse goes (Eq. 54). Contacts that part get nothing, so that none glues.
 *
 * @param active   contacts nearer than R; others do nothing
 * @param impulses out [N s]
 * @param v        velocities without impulses in, with impulses out
 * @return one iteration; the residual is the greatest approach that is left among the active
 * contacts [m/s], which the law does not ask to vanish
 */
template <int dim>
IterationReport solve_stick_slip(Delassus<dim>                       &delassus,
                                 const std::vector<bool>             &active,
                                 std::vector<dealii::Tensor<1, dim>> &impulses,
                                 LaneVelocities<dim>                 &v,
                                 MPI_Comm                             communicator);
} // namespace coracle::contact
