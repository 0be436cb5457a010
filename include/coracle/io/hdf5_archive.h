// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/archive.h>

#include <hdf5.h>

namespace coracle
{
/**
 * An archive as one HDF5 file for each rank, a dataset for each block. It is
 * built in memory, so that the library never meets a full disk, and may then be
 * written and checked in one piece.
 */
class Hdf5Archive : public ArchiveStore
{
public:
  /// To be filled.
  Hdf5Archive();
  /// What each rank saved. Throws RunFailure where HDF5 can't read it.
  explicit Hdf5Archive(const std::vector<std::string> &files);
  ~Hdf5Archive() override;
  Hdf5Archive(const Hdf5Archive &) = delete;

  void put(const std::string &name, const Block &block, const void *values) override;
  std::vector<char>
  get(const unsigned int part, const std::string &name, Block &block) const override;
  std::vector<char> get_slice(const unsigned int part,
                              const std::string &name,
                              const Slice       &slice,
                              Block             &block) const override;
  bool              has(const unsigned int part, const std::string &name) const override;
  unsigned int      n_parts() const override { return files.size(); }

  /// The file of what was put, after which nothing more can be.
  std::vector<char> image();

private:
  std::vector<std::string> names;
  /// Opened when they are asked for.
  mutable std::vector<hid_t> files;
  hid_t                      open(const unsigned int part) const;
};
} // namespace coracle
