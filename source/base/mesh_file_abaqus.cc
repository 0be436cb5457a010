// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_file_builder.h"

#include <algorithm>
#include <cctype>
#include <map>

namespace coracle::internal
{
namespace
{
using Kind = MeshFile::Kind;

std::string
trimmed_upper(std::string_view text)
{
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())))
    text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())))
    text.remove_suffix(1);
  std::string result(text);
  for (char &c : result)
    c = std::toupper(static_cast<unsigned char>(c));
  return result;
}

/// Between commas; an empty one at the end, which asks for the next line, is kept.
std::vector<std::string>
fields_of(std::string_view line)
{
  std::vector<std::string> fields;
  for (bool more = true; more;)
    {
      const std::size_t comma = line.find(',');
      more                    = comma != std::string_view::npos;
      fields.push_back(trimmed_upper(line.substr(0, comma)));
      line.remove_prefix(more ? comma + 1 : line.size());
    }
  return fields;
}

/// A line *KEYWORD, NAME=VALUE, FLAG, ...
struct Keyword
{
  std::string                        name;
  std::map<std::string, std::string> options;

  explicit Keyword(const std::string_view &line)
  {
    const auto fields = fields_of(line);
    name              = fields[0];
    for (std::size_t i = 1; i < fields.size(); ++i)
      {
        const std::size_t equal = std::min(fields[i].find('='), fields[i].size());
        options[trimmed_upper(fields[i].substr(0, equal))] =
          trimmed_upper(fields[i].substr(std::min(equal + 1, fields[i].size())));
      }
  }
  std::string option(const std::string &key) const
  {
    const auto found = options.find(key);
    return found == options.end() ? "" : found->second;
  }
};

/// Points of the faces S1, S2, ..., as Abaqus' manual numbers them.
constexpr unsigned int faces_of_quadrilateral[4][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
constexpr unsigned int faces_of_hexahedron[6][4] =
  {{0, 3, 2, 1}, {4, 7, 6, 5}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}};

class Abaqus
{
public:
  Abaqus(TextScanner &in, MeshFile &mesh) : in(in), mesh(mesh), builder{in, mesh} {}

  void read();

private:
  bool        at_data();
  void        skip_data();
  void        read_nodes();
  void        read_elements(const Keyword &keyword);
  void        read_element_set(const Keyword &keyword);
  void        read_surface(const Keyword &keyword);
  void        add_face(const std::size_t element, const std::string &face, const unsigned int id);
  Kind        kind_of(const std::size_t n_points, const std::string &type) const;
  std::size_t element_of(const std::int64_t number) const;

  TextScanner                                     &in;
  MeshFile                                        &mesh;
  MeshFileBuilder                                  builder;
  std::unordered_map<std::int64_t, std::size_t>    element_of_number;
  std::size_t                                      n_faces_of_surfaces = 0;
  std::map<std::string, std::vector<std::int64_t>> sets;
};

void
Abaqus::read()
{
  while (!in.at_end())
    {
      const Keyword keyword(in.rest_of_line());
      if (keyword.name == "*NODE")
        read_nodes();
      else if (keyword.name == "*ELEMENT")
        read_elements(keyword);
      else if (keyword.name == "*ELSET")
        read_element_set(keyword);
      else if (keyword.name == "*SURFACE" && keyword.option("TYPE") != "NODE")
        read_surface(keyword);
      else if (keyword.name == "*INCLUDE")
        in.fail("another file that is included: put both into one");
      else
        skip_data();
    }
}

/// Comments are between lines of data too.
bool
Abaqus::at_data()
{
  while (in.begins_with('*'))
    if (!in.skip_line_of("**"))
      return false;
  return !in.at_end();
}

void
Abaqus::skip_data()
{
  while (at_data())
    in.rest_of_line();
}

void
Abaqus::read_nodes()
{
  while (at_data())
    {
      const auto fields = fields_of(in.rest_of_line());
      if (fields.size() < 3)
        in.fail("a point needs a number and two coordinates or three");
      dealii::Point<3> place;
      for (std::size_t d = 0; d < 3 && d + 1 < fields.size(); ++d)
        if (!fields[d + 1].empty())
          place[d] = in.to_real(fields[d + 1], "coordinate");
      builder.add_point(in.to_integer(fields[0], "number of a point"), place);
    }
}

Kind
Abaqus::kind_of(const std::size_t n_points, const std::string &type) const
{
  const bool solid = type.compare(0, 3, "C3D") == 0;
  if (n_points == 2)
    return Kind::line;
  if (n_points == 3 && !solid)
    return Kind::triangle;
  if (n_points == 4)
    return solid ? Kind::tetrahedron : Kind::quadrilateral;
  if (n_points == 8 && (solid || type.empty()))
    return Kind::hexahedron;
  in.fail(std::to_string(n_points) + " points of an element of type '" + type +
          "', which is none of lines, triangles, quadrilaterals, tetrahedra and hexahedra of "
          "first order");
}

void
Abaqus::read_elements(const Keyword &keyword)
{
  const std::string type = keyword.option("TYPE");
  while (at_data())
    {
      auto fields = fields_of(in.rest_of_line());
      // A comma at the end: the list goes on.
      while (fields.size() > 1 && fields.back().empty())
        {
          fields.pop_back();
          if (fields.size() >= 9 || !at_data())
            break;
          const auto more = fields_of(in.rest_of_line());
          fields.insert(fields.end(), more.begin(), more.end());
        }
      MeshFile::Element element{kind_of(fields.size() - 1, type), {}, 0, in.line()};
      for (std::size_t i = 0; i + 1 < fields.size(); ++i)
        element.points[i] = builder.index(in.to_integer(fields[i + 1], "number of a point"));
      const auto number = in.to_integer(fields[0], "number of an element");
      if (!element_of_number.emplace(number, mesh.elements.size()).second)
        in.fail("there is another element with the number " + std::to_string(number));
      mesh.elements.push_back(element);
    }
}

void
Abaqus::read_element_set(const Keyword &keyword)
{
  auto      &set      = sets[keyword.option("ELSET")];
  const bool generate = keyword.options.count("GENERATE") > 0;
  while (at_data())
    {
      std::vector<std::int64_t> numbers;
      for (const std::string &field : fields_of(in.rest_of_line()))
        if (!field.empty())
          {
            numbers.push_back(in.to_integer(field, "number of an element"));
            if (numbers.back() < 1)
              in.fail("numbers of elements begin with 1");
          }
      if (!generate)
        {
          set.insert(set.end(), numbers.begin(), numbers.end());
          continue;
        }
      if (numbers.size() == 2)
        numbers.push_back(1);
      if (numbers.size() != 3 || numbers[2] < 1)
        in.fail("GENERATE needs a first number, a last one and an increment");
      // Only elements that exist are looked for, not all numbers to the last.
      for (const auto &[number, element] : element_of_number)
        if (number >= numbers[0] && number <= numbers[1] && (number - numbers[0]) % numbers[2] == 0)
          set.push_back(number);
      // Many lines must not add up to more than there is.
      std::sort(set.begin(), set.end());
      set.erase(std::unique(set.begin(), set.end()), set.end());
    }
}

std::size_t
Abaqus::element_of(const std::int64_t number) const
{
  const auto found = element_of_number.find(number);
  if (found == element_of_number.end())
    in.fail("there is no element with the number " + std::to_string(number));
  return found->second;
}

void
Abaqus::add_face(const std::size_t element, const std::string &face, const unsigned int id)
{
  const auto        solid     = mesh.elements[element];
  const bool        is_volume = (solid.kind == Kind::hexahedron);
  const std::size_t n_faces = (is_volume ? 6 : 4), n = face.size();
  if (!is_volume && solid.kind != Kind::quadrilateral)
    in.fail("a surface of elements that are neither quadrilaterals nor hexahedra");
  if (n != 2 || (face[0] != 'S' && face[0] != 'E') || face[1] < '1' ||
      face[1] > static_cast<char>('0' + n_faces))
    in.fail("'" + face.substr(0, 10) + "' is no face of an element, as S1");
  if (++n_faces_of_surfaces > 6 * element_of_number.size())
    in.fail("the surfaces have more faces than all elements together");
  MeshFile::Element result{is_volume ? Kind::quadrilateral : Kind::line, {}, id, in.line()};
  for (unsigned int p = 0; p < MeshFile::n_points(result.kind); ++p)
    result.points[p] = solid.points[is_volume ? faces_of_hexahedron[face[1] - '1'][p]
                                              : faces_of_quadrilateral[face[1] - '1'][p]];
  mesh.elements.push_back(result);
}

void
Abaqus::read_surface(const Keyword &keyword)
{
  std::string digits;
  for (const char c : keyword.option("NAME"))
    if (c >= '0' && c <= '9')
      digits += c;
  const auto id = digits.empty() ? 0 : in.to_integer(digits, "number of a surface");
  if (id >= 0xffffffff)
    in.fail("the number of a surface is too large");
  while (at_data())
    {
      const auto fields = fields_of(in.rest_of_line());
      if (fields.size() < 2)
        in.fail("a surface needs elements and the face of each");
      const auto set = sets.find(fields[0]);
      if (set == sets.end())
        add_face(element_of(in.to_integer(fields[0], "number or set of elements")), fields[1], id);
      else
        for (const std::int64_t number : set->second)
          add_face(element_of(number), fields[1], id);
    }
}
} // namespace

void
read_abaqus(TextScanner &in, MeshFile &mesh)
{
  Abaqus(in, mesh).read();
}
} // namespace coracle::internal
