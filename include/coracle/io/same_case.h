// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/parameters.h>

namespace coracle
{
/**
 * A run goes on with a parameter file that may differ from the one it was
 * started with in what does not make the state: end, time step, output,
 * checkpoints, tolerances. Anything else is a UserError that names every such
 * entry with both values.
 * @return a line for each entry that has changed
 */
std::vector<std::string> check_same_case(const Parameters &now, const Parameters &then);
} // namespace coracle
