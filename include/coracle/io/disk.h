// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace coracle
{
/// Throws the RunFailure of a result that could not be written. Not collective: see mpi::agree().
[[noreturn]] void throw_not_written(const std::string &what_went_wrong);

/**
 * Write the whole file beside its place, then move it there, so that a reader
 * never meets half of it. Not collective; throws as above.
 */
void write_file(const std::string &file_name, const std::string &content);
} // namespace coracle
