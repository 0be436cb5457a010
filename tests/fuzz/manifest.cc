// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever the manifest of a checkpoint holds, the checkpoint is taken, or passed over with a
// reason that names it. Of an input that begins with '{' the rest is put behind a right checksum.

#include <coracle/base/exceptions.h>
#include <coracle/io/checkpoint_folder.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include "target.h"

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  using namespace coracle;
  fuzz::start();
  const std::string folder = fuzz::place() + "/checkpoints/step_0000000001";
  static const bool made   = [&] {
    std::filesystem::create_directories(folder);
    fuzz::write(folder + "/state.000000.h5", "abc", 3);
    fuzz::write(folder + "/parameters.prm", "", 0);
    return true;
  }();
  (void)made;
  std::string text(reinterpret_cast<const char *>(data), size);
  if (!text.empty() && text[0] == '{')
    {
      int        depth  = 0;
      const auto parsed = nlohmann::json::parse(
        text,
        [&depth](const int at, const auto, const auto &) {
          depth = std::max(depth, at);
          return true;
        },
        false);
      // Printing is recursive.
      if (!parsed.is_discarded() && depth < 100)
        {
          // As the program writes it: in its own order, which the checksum is of.
          std::string contents;
          try
            {
              contents = parsed.dump();
            }
          catch (const nlohmann::json::exception &)
            {
              return 0;
            }
          text = "{\"contents\": " + contents + ", \"crc32\": " +
                 std::to_string(
                   crc32(0, reinterpret_cast<const Bytef *>(contents.data()), contents.size())) +
                 "}";
        }
    }
  fuzz::write(folder + "/manifest.json", text.data(), text.size());
  std::vector<std::string> complaints;
  const auto found = CheckpointFolder(fuzz::place(), MPI_COMM_SELF).newest_good(complaints);
  if (found ? (found->facts.n_ranks > size || !complaints.empty()) : complaints.size() != 1)
    std::abort();
  return 0;
}
