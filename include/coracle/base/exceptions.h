// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace coracle
{
/**
 * A mistake that the user can mend: a title, where it is, what was found, and
 * what to change. Thrown before or during a run, on every rank alike; the main
 * program prints it once and ends with exit code 2.
 */
class UserError : public std::runtime_error
{
public:
  UserError(const std::string &title,
            const std::string &where,
            const std::string &found,
            const std::string &cure);

  const std::string title, where, found, cure;
};

/**
 * The simulation cannot go on (NaN, inverted element, collapsed time step, a
 * lost particle): what, where, when. The run ends with verdict FAILED and exit
 * code 3. Thrown by one rank or by all; see base/mpi.h.
 */
class RunFailure : public std::runtime_error
{
public:
  RunFailure(const std::string &title, const std::string &details, const std::string &cure);

  const std::string title, details, cure;
};

/// The message as the user sees it, "error: <title>" and an indented line for each of the rest.
std::string describe(const UserError &error);
std::string describe(const RunFailure &error);
} // namespace coracle
