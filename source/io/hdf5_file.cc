// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/io/hdf5_file.h>

namespace coracle
{
Hdf5File::Hdf5File(const std::string &file_name, MPI_Comm communicator) : name(file_name)
{
  // What the library would print on each rank is told once, by whoever asks for problem().
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);

  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_mpio(access, communicator, MPI_INFO_NULL);
  file = H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  H5Pclose(access);
  check(file >= 0, "the file could not be created");

  transfer = H5Pcreate(H5P_DATASET_XFER);
  H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE);
}

Hdf5File::~Hdf5File()
{
  close();
}

void
Hdf5File::close()
{
  if (transfer >= 0)
    H5Pclose(transfer);
  if (file >= 0)
    check(H5Fclose(file) >= 0, "the file could not be closed");
  file = transfer = -1;
}

void
Hdf5File::set_attribute(const std::string &dataset, const std::string &key, const double value)
{
  write_attribute(dataset, key, H5T_NATIVE_DOUBLE, &value);
}

void
Hdf5File::set_attribute(const std::string &dataset,
                        const std::string &key,
                        const std::string &value)
{
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, std::max<std::size_t>(value.size(), 1));
  write_attribute(dataset, key, type, value.c_str());
  H5Tclose(type);
}

void
Hdf5File::write_attribute(const std::string &dataset,
                          const std::string &key,
                          const hid_t        type,
                          const void        *value)
{
  if (!why.empty())
    return;
  const hid_t object    = H5Oopen(file, dataset.empty() ? "/" : dataset.c_str(), H5P_DEFAULT);
  const hid_t space     = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(object, key.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT);
  check(attribute >= 0 && H5Awrite(attribute, type, value) >= 0,
        "attribute '" + key + "' could not be written");
  H5Aclose(attribute);
  H5Sclose(space);
  H5Oclose(object);
}

void
Hdf5File::write_rows(const std::string  &dataset,
                     const hid_t         type,
                     const void         *values,
                     const RowPartition &rows)
{
  if (!why.empty())
    return;
  const hsize_t extent[]     = {rows.total, rows.n_components};
  const hsize_t local[]      = {rows.local, rows.n_components};
  const hsize_t first[]      = {rows.first, 0};
  const hid_t   file_space   = H5Screate_simple(2, extent, nullptr);
  const hid_t   memory_space = H5Screate_simple(2, local, nullptr);
  const hid_t   set =
    H5Dcreate2(file, dataset.c_str(), type, file_space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);

  // The write is collective: a rank without rows takes part with an empty selection.
  if (rows.local > 0)
    H5Sselect_hyperslab(file_space, H5S_SELECT_SET, first, nullptr, local, nullptr);
  else
    {
      H5Sselect_none(file_space);
      H5Sselect_none(memory_space);
    }
  // HDF5 refuses a null buffer even where nothing is to be written, and a dataset without storage.
  const double      nothing = 0;
  const void *const buffer  = (rows.local > 0 ? values : &nothing);
  const bool        good =
    set >= 0 &&
    (rows.total == 0 || H5Dwrite(set, type, memory_space, file_space, transfer, buffer) >= 0);
  check(good, "dataset '" + dataset + "' could not be written");
  H5Dclose(set);
  H5Sclose(memory_space);
  H5Sclose(file_space);
}

void
Hdf5File::check(const bool good, const std::string &what)
{
  if (!good && why.empty())
    why = name + ": " + what;
}
} // namespace coracle
