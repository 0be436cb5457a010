// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace coracle
{
/// Throws the RunFailure of a result that could not be written. Not collective: see mpi::agree().
[[noreturn]] void throw_not_written(const std::string &what_went_wrong);

/**
 * Write the whole file beside its place, then move it there, so that a reader
 * never meets half of it. Not collective; throws as above.
 */
void write_file(const std::string &file_name, const std::string &content);

/// What is in a file or folder outlives a failure of power from now on. Throws as above.
void make_durable(const std::string &name);

/// Write a new file, durably. Throws as above.
void write_durable(const std::string &file_name, const std::vector<char> &content);

/// Size and CRC-32 of a file; false if it can't be read.
bool measure_file(const std::string &file_name, std::uint64_t &size, std::uint64_t &checksum);
} // namespace coracle
