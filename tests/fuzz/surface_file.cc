// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever an STL file holds, it is read as finite triangles or refused.

#include <coracle/particles/shape_surface.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include <unistd.h>

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  static const std::string name = "/dev/shm/fuzz_surface_" + std::to_string(getpid()) + ".stl";
  std::ofstream(name, std::ios::binary).write(reinterpret_cast<const char *>(data), size);
  try
    {
      for (const auto &facet : coracle::read_facets<3>(name))
        for (const auto &vertex : facet)
          if (!std::isfinite(vertex.norm_square()) &&
              !std::isfinite(vertex[0] + vertex[1] + vertex[2]))
            std::abort();
    }
  catch (const std::runtime_error &)
    {}
  return 0;
}
