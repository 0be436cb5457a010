// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_file_builder.h"

#include <array>

namespace coracle::internal
{
namespace
{
constexpr std::int64_t point_type = 15;

MeshFile::Kind
kind_of(const std::int64_t type)
{
  using Kind = MeshFile::Kind;
  switch (type)
    {
      case 1:
        return Kind::line;
      case 2:
        return Kind::triangle;
      case 3:
        return Kind::quadrilateral;
      case 4:
        return Kind::tetrahedron;
      case 5:
        return Kind::hexahedron;
      default:
        return Kind::other;
    }
}

/// One file; formats 10, 20 to 22, 40, 41.
class Gmsh
{
public:
  Gmsh(TextScanner &in, MeshFile &mesh) : in(in), builder{in, mesh} {}

  void read();

private:
  void read_format();
  void skip_section(const std::string_view &name);
  void read_entities();
  void read_nodes();
  void read_elements();
  void read_block_of_nodes();
  void read_block_of_elements();
  void read_element_of_1_or_2();
  /// Points are left out; what is unknown cannot be, because its length is not known.
  void         read_points(const std::int64_t type, const unsigned int id);
  unsigned int id_of(const std::int64_t physical_group) const;

  TextScanner    &in;
  MeshFileBuilder builder;
  int             format = 0;
  /// Physical groups of points, curves, surfaces, volumes by their tags.
  std::array<std::unordered_map<std::int64_t, unsigned int>, 4> groups;
};

void
Gmsh::read()
{
  while (!in.at_end())
    {
      const auto word = in.word();
      if (word == "$MeshFormat" && format == 0)
        read_format();
      else if (word == "$NOD" && format == 0)
        {
          format = 10;
          read_nodes();
          in.expect("$ENDNOD");
        }
      else if (format == 0)
        in.fail("the file does not begin with $MeshFormat or $NOD");
      else if (word == "$ELM" && format == 10)
        {
          read_elements();
          in.expect("$ENDELM");
        }
      else if (word == "$Entities" && format >= 40)
        {
          read_entities();
          in.expect("$EndEntities");
        }
      else if (word == "$Nodes" && format > 10)
        {
          read_nodes();
          in.expect("$EndNodes");
        }
      else if (word == "$Elements" && format > 10)
        {
          read_elements();
          in.expect("$EndElements");
        }
      else
        skip_section(word);
    }
}

void
Gmsh::read_format()
{
  const double version = in.real("version");
  if (version > 0 && version < 10)
    format = static_cast<int>(10 * version + 0.5);
  if ((format < 20 || format > 22) && format != 40 && format != 41)
    in.fail("a version of gmsh's format that is not 1, 2 to 2.2, 4 or 4.1");
  if (in.integer("type of file") != 0)
    in.fail("a binary file: save it as text");
  in.integer("size of numbers");
  in.expect("$EndMeshFormat");
}

void
Gmsh::skip_section(const std::string_view &name)
{
  if (name.size() < 2 || name[0] != '$')
    in.fail("a section should begin here, with a name as $Nodes");
  const std::size_t begin = in.line();
  const std::string end   = "$End" + std::string(name.substr(1));
  while (!in.at_end())
    if (in.word() == end)
      return;
  in.fail("this section has no end", begin);
}

unsigned int
Gmsh::id_of(const std::int64_t physical_group) const
{
  constexpr std::int64_t largest = 0xfffffffe;
  if (physical_group < -largest || physical_group > largest)
    in.fail("a physical group with the number " + std::to_string(physical_group));
  // Negative where an entity is turned round.
  return std::abs(physical_group);
}

void
Gmsh::read_entities()
{
  std::array<std::size_t, 4> n;
  for (auto &count : n)
    count = in.count("entities");
  for (unsigned int d = 0; d < 4; ++d)
    for (std::size_t i = 0; i < n[d]; ++i)
      {
        const auto tag = in.integer("tag");
        // Points have a box with two corners in version 4.0.
        for (int k = 0; k < (d == 0 && format > 40 ? 3 : 6); ++k)
          in.real("coordinate");
        const std::size_t n_groups = in.count("physical groups");
        if (n_groups > 1)
          in.fail("more than one physical group of one entity");
        groups[d][tag] = (n_groups == 1 ? id_of(in.integer("physical group")) : 0);
        if (d > 0)
          for (std::size_t k = in.count("tags"); k > 0; --k)
            in.integer("tag");
      }
}

void
Gmsh::read_nodes()
{
  if (format >= 40)
    {
      const std::size_t n_blocks = in.count("blocks");
      in.count("points");
      if (format > 40)
        for (int i = 0; i < 2; ++i)
          in.integer("tag");
      for (std::size_t block = 0; block < n_blocks; ++block)
        read_block_of_nodes();
    }
  else
    for (std::size_t n = in.count("points"); n > 0; --n)
      {
        const auto number = in.integer("number of a point");
        builder.add_point(number, builder.read_place());
      }
}

void
Gmsh::read_block_of_nodes()
{
  const std::int64_t first = in.integer("tag"), second = in.integer("tag"),
                     dimension         = (format > 40 ? first : second);
  const bool                parametric = in.integer("flag") != 0;
  const std::size_t         n          = in.count("points");
  std::vector<std::int64_t> numbers;
  if (format > 40)
    for (std::size_t i = 0; i < n; ++i)
      numbers.push_back(in.integer("number of a point"));
  for (std::size_t i = 0; i < n; ++i)
    {
      const auto number = (format > 40 ? numbers[i] : in.integer("number of a point"));
      builder.add_point(number, builder.read_place());
      for (int d = 0; parametric && d < 3 && d < dimension; ++d)
        in.real("parametric coordinate");
    }
}

void
Gmsh::read_elements()
{
  if (format >= 40)
    {
      const std::size_t n_blocks = in.count("blocks");
      in.count("elements");
      if (format > 40)
        for (int i = 0; i < 2; ++i)
          in.integer("tag");
      for (std::size_t block = 0; block < n_blocks; ++block)
        read_block_of_elements();
    }
  else
    for (std::size_t n = in.count("elements"); n > 0; --n)
      read_element_of_1_or_2();
}

void
Gmsh::read_block_of_elements()
{
  const std::int64_t first = in.integer("tag"), second = in.integer("tag"),
                     dimension = (format > 40 ? first : second),
                     tag = (format > 40 ? second : first), type = in.integer("type of an element");
  if (dimension < 0 || dimension > 3)
    in.fail("elements of dimension " + std::to_string(dimension));
  // Files without entities have no groups.
  const auto         group = groups[dimension].find(tag);
  const unsigned int id    = (group != groups[dimension].end() ? group->second : 0);
  for (std::size_t n = in.count("elements"); n > 0; --n)
    {
      in.integer("number of an element");
      read_points(type, id);
    }
}

void
Gmsh::read_element_of_1_or_2()
{
  in.integer("number of an element");
  const std::int64_t type = in.integer("type of an element");
  unsigned int       id   = 0;
  if (format < 20)
    {
      id = id_of(in.integer("physical group"));
      in.integer("tag");
      const std::size_t n = in.count("points");
      if (kind_of(type) != MeshFile::Kind::other && n != MeshFile::n_points(kind_of(type)))
        in.fail(std::to_string(n) + " points of an element of type " + std::to_string(type));
    }
  else
    for (std::size_t n = in.count("tags"), i = 0; i < n; ++i)
      {
        const auto tag = in.integer("tag");
        if (i == 0)
          id = id_of(tag);
      }
  read_points(type, id);
}

void
Gmsh::read_points(const std::int64_t type, const unsigned int id)
{
  if (type == point_type)
    builder.index(in.integer("number of a point"));
  else if (kind_of(type) != MeshFile::Kind::other)
    builder.read_element(kind_of(type), id);
  else
    in.fail("elements of type " + std::to_string(type) +
            ", which are none of lines, triangles, quadrilaterals, tetrahedra and hexahedra of "
            "first order");
}
} // namespace

void
read_gmsh(TextScanner &in, MeshFile &mesh)
{
  Gmsh(in, mesh).read();
}
} // namespace coracle::internal
