// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/io/disk.h>
#include <coracle/io/hdf5_file.h>
#include <coracle/io/particle_output.h>
#include <coracle/io/text.h>

#include <numeric>

namespace coracle
{
namespace
{
/// One moment of the XDMF collection. The format has a default for the cells of a polyvertex (point
/// i is cell i), but with it ParaView makes points without cells, which it does not draw: hence
/// `cells`.
std::string
xdmf_grid(const double              time,
          const std::string        &file,
          const std::uint64_t       n,
          const std::vector<Field> &fields,
          const bool                single_precision)
{
  const auto item = [&](const Field &field) {
    const unsigned int m = n_written_components(field);
    return "<DataItem Dimensions=\"" + std::to_string(n) + (m > 1 ? " 3" : "") +
           "\" NumberType=\"Float\" Precision=\"" + (single_precision && !field.exact ? "4" : "8") +
           "\" Format=\"HDF\">" + xml_text(file + ":/" + field.name) + "</DataItem>";
  };

  const std::string cells = "<DataItem Dimensions=\"" + std::to_string(n) +
                            " 1\" NumberType=\"UInt\" Precision=\"4\" Format=\"HDF\">" +
                            xml_text(file + ":/cells") + "</DataItem>";
  std::string grid =
    "<Grid Name=\"particles\" GridType=\"Uniform\">\n<Time Value=\"" + exact_number(time) +
    "\"/>\n<Topology TopologyType=\"Polyvertex\" "
    "NumberOfElements=\"" +
    std::to_string(n) + "\" NodesPerElement=\"1\">" + cells +
    "</Topology>\n<Geometry GeometryType=\"XYZ\">" + item(fields[0]) + "</Geometry>\n";
  for (unsigned int f = 1; f < fields.size(); ++f)
    grid += "<Attribute Name=\"" + xml_text(fields[f].name) + "\" AttributeType=\"" +
            (n_written_components(fields[f]) == 1 ? "Scalar" : "Vector") + "\" Center=\"Node\">" +
            item(fields[f]) + "</Attribute>\n";
  return grid + "</Grid>\n";
}
} // namespace

ParticleOutput::ParticleOutput(OutputDirectory      &directory,
                               const std::string    &body,
                               const ParticleFormat &format)
  : folder(directory.path())
  , name(directory.claim(body))
  , title(body)
  , format(format)
  , comm(directory.communicator())
{
  if (format.vtu)
    vtu = std::make_unique<VtuSeries>(directory, name, format.single_precision);
}

void
ParticleOutput::serialize(Archive &archive)
{
  if (archive.has(name + ".grids"))
    archive.same(name + ".grids", grids);
  if (vtu)
    vtu->serialize(archive);
  if (archive.loads() && !grids.empty())
    write_xdmf();
}

void
ParticleOutput::write(const double              time,
                      const std::size_t         n_particles,
                      const std::vector<Field> &fields)
{
  Assert(!fields.empty() && fields[0].name == "position" && fields[0].components.size() > 1,
         dealii::ExcMessage("The first field of a particle output must be the position."));

  if (format.hdf5)
    write_hdf5(time, n_particles, split_tensors(fields));
  if (vtu)
    {
      VtuPiece piece;
      piece.n_points     = n_particles;
      piece.position     = fields[0];
      piece.point_fields = {fields.begin() + 1, fields.end()};
      vtu->write(time, piece);
    }
}

void
ParticleOutput::write_hdf5(const double              time,
                           const std::size_t         n_particles,
                           const std::vector<Field> &fields)
{
  const std::string file_name = "data/" + name + "." + six_digits(grids.size()) + ".h5";
  RowPartition      rows;
  rows.local = n_particles;
  rows.total = mpi::sum<std::uint64_t>(n_particles, comm);
  rows.first = mpi::offset<std::uint64_t>(n_particles, comm);

  Hdf5File file(folder + "/" + file_name, comm);
  file.set_attribute("", "time", time);
  std::vector<unsigned int> cells(n_particles);
  std::iota(cells.begin(), cells.end(), static_cast<unsigned int>(rows.first));
  file.write_rows("cells", H5T_NATIVE_UINT, cells.data(), rows);
  for (const Field &field : fields)
    {
      rows.n_components = n_written_components(field);
      if (format.single_precision && !field.exact)
        file.write_rows(field.name,
                        H5T_NATIVE_FLOAT,
                        interleave<float>(field, n_particles).data(),
                        rows);
      else
        file.write_rows(field.name,
                        H5T_NATIVE_DOUBLE,
                        interleave<double>(field, n_particles).data(),
                        rows);
      file.set_attribute(field.name, "unit", field.unit);
    }
  file.close();
  mpi::agree(
    [&] {
      if (!file.problem().empty())
        throw_not_written(file.problem());
    },
    comm);

  grids.push_back(xdmf_grid(time, file_name, rows.total, fields, format.single_precision));
  write_xdmf();
}

void
ParticleOutput::write_xdmf() const
{
  const auto write = [&] {
    if (mpi::rank(comm) != 0)
      return;
    std::string text = "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.0\">\n<Domain>\n<Grid Name=\"" +
                       xml_text(title) +
                       "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
    for (const std::string &grid : grids)
      text += grid;
    write_file(folder + "/" + name + ".xdmf", text + "</Grid>\n</Domain>\n</Xdmf>\n");
  };
  mpi::agree(write, comm);
}
} // namespace coracle
