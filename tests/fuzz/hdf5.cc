// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes instead of an HDF5 file with the state, as if the checksums of both the file and the
// manifest fitted them: a test of the HDF5 library more than of Coracle, which never hands it such
// a file. (Not run by default: HDF5 1.10.8 fails within seconds.)

#include <coracle/base/exceptions.h>
#include <coracle/io/hdf5_archive.h>

#include "target.h"

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  using namespace coracle;
  fuzz::start();
  const std::string file = fuzz::place() + "/state.h5";
  fuzz::write(file, data, size);
  try
    {
      const Hdf5Archive store({file});
      Block             block;
      for (const char *const name : {"s/time", "s/names", "s/nodes/keys"})
        if (store.has(0, name))
          store.get(0, name, block);
    }
  catch (const RunFailure &)
    {}
  return 0;
}
