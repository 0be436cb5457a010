// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/exceptions.h>

#include <coracle/io/text.h>
#include <coracle/io/vtu_file.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <zlib.h>

namespace coracle
{
namespace
{
const char *const file_attributes =
  R"(version="1.0" byte_order="LittleEndian" header_type="UInt64" )"
  R"(compressor="vtkZLibDataCompressor")";

const char *
real_type(const Field &field, const bool single_precision)
{
  return single_precision && !field.exact ? "Float32" : "Float64";
}

/// The arrays behind the XML, each as: number of blocks, their size, the last one's size if it is
/// shorter, their compressed sizes, the compressed blocks.
class AppendedData
{
public:
  template <typename T>
  std::size_t add(const std::vector<T> &values)
  {
    const std::size_t offset = bytes.size();
    append(reinterpret_cast<const Bytef *>(values.data()), values.size() * sizeof(T));
    return offset;
  }

  const std::string &text() const { return bytes; }

private:
  static constexpr std::size_t block = 1 << 20;

  void append(const Bytef *data, const std::size_t size)
  {
    const std::size_t          n_blocks = (size + block - 1) / block;
    std::vector<std::uint64_t> header   = {n_blocks, block, size % block};
    std::string                blocks;
    std::vector<Bytef>         compressed(compressBound(block));
    for (std::size_t b = 0; b < n_blocks; ++b)
      {
        uLongf     n_compressed = compressed.size();
        const auto n            = std::min(block, size - b * block);
        const int  status =
          compress2(compressed.data(), &n_compressed, data + b * block, n, Z_BEST_SPEED);
        AssertThrow(status == Z_OK, dealii::ExcInternalError());
        header.push_back(n_compressed);
        blocks.append(reinterpret_cast<const char *>(compressed.data()), n_compressed);
      }
    bytes.append(reinterpret_cast<const char *>(header.data()), header.size() * 8);
    bytes += blocks;
  }

  std::string bytes;
};

void
data_array(std::ostream      &xml,
           const std::string &type,
           const std::string &name,
           const unsigned int n_components,
           const std::size_t  offset)
{
  xml << "<DataArray type=\"" << type << "\" Name=\"" << xml_text(name)
      << "\" NumberOfComponents=\"" << n_components << "\" format=\"appended\" offset=\"" << offset
      << "\"/>\n";
}

void
write_field(std::ostream                    &xml,
            AppendedData                    &data,
            const Field                     &field,
            const std::size_t                n,
            const std::vector<unsigned int> *indices,
            const bool                       single_precision)
{
  const bool        single = single_precision && !field.exact;
  const std::size_t offset = single ? data.add(interleave<float>(field, n, indices))
                                    : data.add(interleave<double>(field, n, indices));
  data_array(
    xml, real_type(field, single_precision), field.name, n_written_components(field), offset);
}

struct VtkCell
{
  std::uint8_t              type;
  std::vector<unsigned int> vertex_order; ///< deal.II's vertex for each of VTK's
};

VtkCell
vtk_cell(const CellShape shape)
{
  switch (shape)
    {
      case CellShape::line:
        return {3, {0, 1}};
      case CellShape::triangle:
        return {5, {0, 1, 2}};
      case CellShape::tetrahedron:
        return {10, {0, 1, 2, 3}};
      case CellShape::quadrilateral:
        return {9, {0, 1, 3, 2}};
      case CellShape::hexahedron:
        return {12, {0, 1, 3, 2, 4, 5, 7, 6}};
      case CellShape::vertex:
        break;
    }
  return {1, {0}};
}

void
write_cells(std::ostream &xml, AppendedData &data, const VtuPiece &piece)
{
  const VtkCell             cell    = vtk_cell(piece.shape);
  const std::size_t         n       = cell.vertex_order.size();
  const bool                points  = (piece.shape == CellShape::vertex);
  const std::size_t         n_cells = (points ? piece.n_points : piece.n_cells);
  std::vector<std::int64_t> connectivity(n_cells * n), offsets(n_cells);
  Assert(points || piece.connectivity.size() == n_cells * n, dealii::ExcInternalError());

  for (std::size_t c = 0; c < n_cells; ++c)
    {
      for (unsigned int v = 0; v < n; ++v)
        connectivity[c * n + v] = (points ? c : piece.connectivity[c * n + cell.vertex_order[v]]);
      offsets[c] = (c + 1) * n;
    }
  xml << "<Cells>\n";
  data_array(xml, "Int64", "connectivity", 1, data.add(connectivity));
  data_array(xml, "Int64", "offsets", 1, data.add(offsets));
  data_array(xml, "UInt8", "types", 1, data.add(std::vector<std::uint8_t>(n_cells, cell.type)));
  xml << "</Cells>\n";
}

void
parallel_fields(std::ostream &xml, const std::vector<Field> &fields, const bool single_precision)
{
  for (const Field &field : split_tensors(fields))
    xml << "<PDataArray type=\"" << real_type(field, single_precision) << "\" Name=\""
        << xml_text(field.name) << "\" NumberOfComponents=\"" << n_written_components(field)
        << "\"/>\n";
}
} // namespace

std::string
vtu_text(const VtuPiece &piece, const bool single_precision)
{
  std::ostringstream xml;
  AppendedData       data;
  const std::size_t  n_cells = (piece.shape == CellShape::vertex ? piece.n_points : piece.n_cells);

  xml << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" " << file_attributes
      << ">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" << piece.n_points
      << "\" NumberOfCells=\"" << n_cells << "\">\n<Points>\n";
  write_field(xml, data, piece.position, piece.n_points, piece.points, single_precision);
  xml << "</Points>\n";
  write_cells(xml, data, piece);
  xml << "<PointData>\n";
  for (const Field &field : split_tensors(piece.point_fields))
    write_field(xml, data, field, piece.n_points, piece.points, single_precision);
  xml << "</PointData>\n<CellData>\n";
  for (const Field &field : split_tensors(piece.cell_fields))
    write_field(xml, data, field, n_cells, nullptr, single_precision);
  xml << "</CellData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_"
      << data.text() << "\n</AppendedData>\n</VTKFile>\n";
  return xml.str();
}

std::string
pvtu_text(const VtuPiece &piece, const std::vector<std::string> &files, const bool single_precision)
{
  std::ostringstream xml;
  xml << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" " << file_attributes
      << ">\n<PUnstructuredGrid GhostLevel=\"0\">\n<PPoints>\n";
  parallel_fields(xml, {piece.position}, single_precision);
  xml << "</PPoints>\n<PPointData>\n";
  parallel_fields(xml, piece.point_fields, single_precision);
  xml << "</PPointData>\n<PCellData>\n";
  parallel_fields(xml, piece.cell_fields, single_precision);
  xml << "</PCellData>\n";
  for (const std::string &file : files)
    xml << "<Piece Source=\"" << xml_text(file) << "\"/>\n";
  xml << "</PUnstructuredGrid>\n</VTKFile>\n";
  return xml.str();
}

std::string
pvd_text(const std::vector<std::pair<double, std::string>> &entries)
{
  std::ostringstream xml;
  xml << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const auto &[time, file] : entries)
    xml << "<DataSet timestep=\"" << exact_number(time) << "\" part=\"0\" file=\"" << xml_text(file)
        << "\"/>\n";
  xml << "</Collection>\n</VTKFile>\n";
  return xml.str();
}
} // namespace coracle
