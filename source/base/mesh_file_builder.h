// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/base/mesh_file.h>

#include <unordered_map>

namespace coracle::internal
{
/// What readers of one format put together: points by their numbers in the file.
struct MeshFileBuilder
{
  TextScanner                                   &in;
  MeshFile                                      &mesh;
  std::unordered_map<std::int64_t, unsigned int> index_of_number = {};

  void add_point(const std::int64_t number, const dealii::Point<3> &place);
  /// x, y, z follow.
  dealii::Point<3> read_place();
  unsigned int     index(const std::int64_t number) const;
  /// The numbers of its points follow.
  void read_element(const MeshFile::Kind kind, const unsigned int id);
};

void read_gmsh(TextScanner &in, MeshFile &mesh);
void read_vtk(TextScanner &in, MeshFile &mesh);
void read_abaqus(TextScanner &in, MeshFile &mesh);
void read_ucd(TextScanner &in, MeshFile &mesh);
} // namespace coracle::internal
