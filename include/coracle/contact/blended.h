// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/contact/gauss_seidel.h>

namespace coracle::contact
{
/**
 * The contact force iteration of Song, Liu & Zhang (2020), section 4.2: every
 * contact works out, as if it were alone, the impulse that Eq. 65 asks for at
 * the present velocities, positive ones are applied all at once, and so on until
 * none is left. Impulses never shrink, so that pairs that share nodes overshoot:
 * kept for comparison with the published method. With friction, each of these
 * impulses stops the sliding as far as friction times its normal part allows
 * (Chen et al. 2015, Eq. 52).
 *
 * @param wanted   normal velocity that each contact asks for, alpha (R - g) / dt [m/s]
 * @param active   contacts nearer than R; others do nothing
 * @param v        velocities without impulses in, with impulses out
 */
template <int dim>
IterationReport solve_blended(Delassus<dim>                       &delassus,
                              const std::vector<double>           &wanted,
                              const std::vector<bool>             &active,
                              const IterationLimits               &limits,
                              std::vector<dealii::Tensor<1, dim>> &impulses,
                              LaneVelocities<dim>                 &v,
                              MPI_Comm                             communicator);
} // namespace coracle::contact
