// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exceptions.h>
#include <coracle/io/hdf5_archive.h>

namespace coracle
{
namespace
{
/// The file in memory grows by this [bytes].
constexpr std::size_t growth = std::size_t(16) << 20;

hid_t
type_of(const Block::Type type)
{
  switch (type)
    {
      case Block::Type::real:
        return H5T_NATIVE_DOUBLE;
      case Block::Type::natural:
        return H5T_NATIVE_UINT64;
      case Block::Type::natural_32:
        return H5T_NATIVE_UINT32;
      case Block::Type::integer_32:
        return H5T_NATIVE_INT32;
      default:
        return H5T_NATIVE_UCHAR;
    }
}

/// False if it is none of ours.
bool
find_type(const hid_t stored, Block::Type &type)
{
  for (const auto candidate : {Block::Type::real,
                               Block::Type::natural,
                               Block::Type::natural_32,
                               Block::Type::integer_32,
                               Block::Type::byte})
    if (H5Tequal(stored, type_of(candidate)) > 0)
      {
        type = candidate;
        return true;
      }
  return false;
}

RunFailure
not_readable(const std::string &file, const std::string &name)
{
  return RunFailure("a checkpoint does not fit this case",
                    file + ": '" + name + "' is not in it, or cannot be read",
                    "go on with the program and the parameter file that wrote it");
}
/// A dataset while it is read.
class Dataset
{
public:
  /// @param block what it holds, nothing if it is none of ours or the file has not all of it
  Dataset(const hid_t file, const std::string &name, Block &block)
    : set(H5Dopen2(file, name.c_str(), H5P_DEFAULT))
    , space(set < 0 ? -1 : H5Dget_space(set))
    , type(set < 0 ? -1 : H5Dget_type(set))
    , is_good(set >= 0)
  {
    block                = Block();
    hsize_t extent[2]    = {0, 0};
    hsize_t size_of_file = 0;
    is_good = is_good && H5Sget_simple_extent_ndims(space) == 2 && find_type(type, block.type) &&
              H5Fget_filesize(file, &size_of_file) >= 0;
    if (!is_good)
      return;
    H5Sget_simple_extent_dims(space, extent, nullptr);
    width           = H5Tget_size(type);
    block.n_rows    = extent[0];
    block.n_columns = extent[1];
    // All of it must be in the file; the first test keeps the product from overflowing.
    is_good = extent[0] <= size_of_file && extent[1] <= size_of_file &&
              (extent[1] == 0 || extent[0] <= size_of_file / width / extent[1]);
    const std::size_t size = is_good ? extent[0] * extent[1] * width : 0;
    is_good                = is_good && (size == 0 || H5Dget_storage_size(set) == size);
    n_rows                 = extent[0];
    n_columns              = extent[1];
  }
  ~Dataset()
  {
    if (type >= 0)
      H5Tclose(type);
    if (space >= 0)
      H5Sclose(space);
    if (set >= 0)
      H5Dclose(set);
  }
  Dataset(const Dataset &) = delete;

  std::vector<char> read(const Slice &slice, const std::string &file, const std::string &name) const
  {
    const bool is_inside = slice.first_row <= n_rows && slice.n_rows <= n_rows - slice.first_row &&
                           slice.first_column <= n_columns &&
                           slice.n_columns <= n_columns - slice.first_column;
    if (!is_good || !is_inside)
      throw not_readable(file, name);
    std::vector<char> bytes(slice.n_rows * slice.n_columns * width);
    if (bytes.empty())
      return bytes;
    const hsize_t first[] = {slice.first_row, slice.first_column},
                  count[] = {slice.n_rows, slice.n_columns};
    const hid_t memory    = H5Screate_simple(2, count, nullptr);
    const bool  was_read =
      H5Sselect_hyperslab(space, H5S_SELECT_SET, first, nullptr, count, nullptr) >= 0 &&
      H5Dread(set, type, memory, space, H5P_DEFAULT, bytes.data()) >= 0;
    H5Sclose(memory);
    if (!was_read)
      throw not_readable(file, name);
    return bytes;
  }

private:
  const hid_t set, space, type;
  bool        is_good;
  std::size_t n_rows = 0, n_columns = 0, width = 1;
};
} // namespace

Hdf5Archive::Hdf5Archive() : names(1), files(1, -1)
{
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, growth, false);
  files[0] = H5Fcreate("coracle_checkpoint", H5F_ACC_TRUNC, H5P_DEFAULT, access);
  H5Pclose(access);
  AssertThrow(files[0] >= 0, dealii::ExcMessage("HDF5 has no file in memory."));
}

Hdf5Archive::Hdf5Archive(const std::vector<std::string> &files)
  : names(files), files(files.size(), -1)
{
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Archive::~Hdf5Archive()
{
  for (const hid_t file : files)
    if (file >= 0)
      H5Fclose(file);
}

hid_t
Hdf5Archive::open(const unsigned int part) const
{
  if (files[part] < 0)
    files[part] = H5Fopen(names[part].c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (files[part] < 0)
    throw not_readable(names[part], "/");
  return files[part];
}

void
Hdf5Archive::put(const std::string &name, const Block &block, const void *const values)
{
  const hsize_t extent[] = {block.n_rows, block.n_columns};
  const hid_t   space    = H5Screate_simple(2, extent, nullptr);
  const hid_t   links    = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  // The same state makes the same file.
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(creation, false);
  const hid_t set =
    H5Dcreate2(files[0], name.c_str(), type_of(block.type), space, links, creation, H5P_DEFAULT);
  const bool good =
    set >= 0 && (block.n_rows * block.n_columns == 0 ||
                 H5Dwrite(set, type_of(block.type), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
  H5Dclose(set);
  H5Pclose(creation);
  H5Pclose(links);
  H5Sclose(space);
  AssertThrow(good, dealii::ExcMessage("HDF5 cannot take '" + name + "' of a checkpoint."));
}

bool
Hdf5Archive::has(const unsigned int part, const std::string &name) const
{
  const hid_t file = open(part);
  for (std::size_t end = 0; end != std::string::npos;)
    {
      end = name.find('/', end + 1);
      if (H5Lexists(file, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0)
        return false;
    }
  return true;
}

std::vector<char>
Hdf5Archive::get(const unsigned int part, const std::string &name, Block &block) const
{
  const Dataset set(open(part), name, block);
  return set.read({0, block.n_rows, 0, block.n_columns}, names[part], name);
}

std::vector<char>
Hdf5Archive::get_slice(const unsigned int part,
                       const std::string &name,
                       const Slice       &slice,
                       Block             &block) const
{
  const Dataset set(open(part), name, block);
  return set.read(slice, names[part], name);
}

std::vector<char>
Hdf5Archive::image()
{
  H5Fflush(files[0], H5F_SCOPE_GLOBAL);
  std::vector<char> bytes(std::max<ssize_t>(0, H5Fget_file_image(files[0], nullptr, 0)));
  AssertThrow(H5Fget_file_image(files[0], bytes.data(), bytes.size()) > 0,
              dealii::ExcMessage("HDF5 does not give a checkpoint back."));
  H5Fclose(files[0]);
  files[0] = -1;
  return bytes;
}
} // namespace coracle
