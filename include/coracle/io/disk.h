// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/mpi.h>

#include <string>

namespace coracle
{
/**
 * Write the whole file beside its place, then move it there, so that a reader
 * never meets half of it. Not collective.
 *
 * @return empty, or what went wrong (disk full, folder gone), for throw_if_any()
 */
std::string write_file(const std::string &file_name, const std::string &content);

/**
 * Collective. If any rank brings a problem, throws a RunFailure that names the
 * problem of the lowest such rank, on all ranks.
 */
void throw_if_any(const std::string &problem, MPI_Comm communicator);
} // namespace coracle
