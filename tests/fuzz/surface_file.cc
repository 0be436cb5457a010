// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever an STL file holds, it is read as finite triangles or refused.

#include <coracle/base/text_scanner.h>
#include <coracle/particles/shape_surface.h>

#include <cmath>
#include <cstdlib>

#include "target.h"

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  static const std::string name = fuzz::place() + "/surface.stl";
  fuzz::start();
  fuzz::write(name, data, size);
  try
    {
      for (const auto &facet : coracle::read_facets<3>(name))
        for (const auto &vertex : facet)
          if (!std::isfinite(vertex.norm_square()) &&
              !std::isfinite(vertex[0] + vertex[1] + vertex[2]))
            std::abort();
    }
  catch (const coracle::FileError &)
    {}
  return 0;
}
