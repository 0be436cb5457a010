// SPDX-License-Identifier: GPL-3.0-or-later
// Of checkpoints the newest kept are found; one with a file that is shorter, longer, changed,
// missing, or of another version is passed over and named; what was not finished is never seen.
#include <coracle/base/exceptions.h>
#include <coracle/base/mpi.h>
#include <coracle/io/checkpoint_folder.h>
#include <coracle/io/disk.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include "tests.h"

using namespace coracle;
namespace fs = std::filesystem;

namespace
{
std::string
file_of(const int rank)
{
  return "part." + std::to_string(rank);
}

void
write(CheckpointFolder &folder, const unsigned int step, const unsigned int n_kept)
{
  const int         rank = mpi::rank(MPI_COMM_WORLD), n = mpi::n_ranks(MPI_COMM_WORLD);
  const std::string path = folder.begin(step);
  write_durable(path + "/" + file_of(rank), std::vector<char>(100 + rank, 'x'));
  folder.commit({2, static_cast<unsigned int>(n), step, 0.1 * step}, {file_of(rank)}, n_kept);
}

void
report(const CheckpointFolder &folder, const std::string &what)
{
  std::vector<std::string> complaints;
  const auto               found = folder.newest_good(complaints);
  deallog << what << ": ";
  if (found)
    deallog << "step " << found->facts.step << " of dimension " << found->facts.dimension
            << " at t = " << found->facts.time;
  else
    deallog << "none";
  deallog << std::endl;
  for (const std::string &complaint : complaints)
    deallog << "  " << complaint << std::endl;
}

/// What is said of the newest only.
void
report_newest(const CheckpointFolder &folder, const std::string &what)
{
  std::vector<std::string> complaints;
  const auto               found = folder.newest_good(complaints);
  deallog << what << ": "
          << (complaints.empty() ? "step " + std::to_string(found->facts.step) : complaints[0])
          << std::endl;
}

/// On rank 0, while nobody looks.
void
damage(const std::function<void()> &action)
{
  MPI_Barrier(MPI_COMM_WORLD);
  if (mpi::rank(MPI_COMM_WORLD) == 0)
    action();
  MPI_Barrier(MPI_COMM_WORLD);
}
} // namespace

namespace
{
using Json = nlohmann::json;

/// Change the manifest of step 5 for a while, with a right checksum or not.
void
forge(const CheckpointFolder            &folder,
      const std::string                 &what,
      const std::function<void(Json &)> &change,
      const bool                         right = true)
{
  const std::string file = "run/checkpoints/step_0000000005/manifest.json";
  Json              manifest;
  damage([&] {
    std::ifstream(file) >> manifest;
    Json forged = manifest;
    change(forged);
    if (right)
      {
        const std::string text = forged["contents"].dump();
        forged["crc32"] = crc32(0, reinterpret_cast<const Bytef *>(text.data()), text.size());
      }
    std::ofstream(file) << forged;
  });
  report_newest(folder, what);
  damage([&] { std::ofstream(file) << manifest; });
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi_initialization(argc, argv, 1);
  mpi_initlog();
  const std::string last =
    "run/checkpoints/step_0000000005/" + file_of(mpi::n_ranks(MPI_COMM_WORLD) - 1);
  damage([] { fs::remove_all("run"); });
  CheckpointFolder folder("run", MPI_COMM_WORLD);
  report(folder, "before the first");
  for (unsigned int step = 1; step <= 5; ++step)
    write(folder, step, 3);
  report(folder, "after five");
  damage([] {
    unsigned int n = 0;
    for (const auto &entry : fs::directory_iterator("run/checkpoints"))
      n += !entry.path().empty();
    deallog << "kept: " << n << std::endl;
  });

  folder.begin(6);
  report(folder, "while another is written");
  folder.abandon();

  damage([&] { fs::resize_file(last, 50); });
  report(folder, "a file is shorter");
  damage([&] { std::ofstream(last, std::ios::trunc) << std::string(200, 'x'); });
  report(folder, "a file is longer");
  damage([&] { fs::remove(last); });
  report(folder, "a file is gone");
  write(folder, 5, 3);
  report(folder, "written anew");
  damage([&] {
    std::fstream file(last, std::ios::in | std::ios::out);
    file.seekp(20);
    file.put('y');
  });
  report(folder, "a byte is another");

  damage([] {
    const std::string manifest = "run/checkpoints/step_0000000004/manifest.json";
    std::stringstream text;
    text << std::ifstream(manifest).rdbuf();
    std::string changed = text.str();
    changed.replace(changed.find("\"step\": 4"), 9, "\"step\": 9");
    std::ofstream(manifest) << changed;
  });
  report(folder, "a manifest is changed");
  damage([] { fs::remove("run/checkpoints/step_0000000003/manifest.json"); });
  report(folder, "a manifest is gone");

  // What no damage makes, but somebody could.
  write(folder, 5, 3);
  forge(
    folder, "a checksum that is no number", [](Json &manifest) { manifest["crc32"] = "1"; }, false);
  forge(
    folder, "no contents", [](Json &manifest) { manifest.erase("contents"); }, false);
  forge(
    folder,
    "a list",
    [](Json &manifest) {
      manifest = Json::array({1, 2});
    },
    false);
  forge(folder, "no number of the format", [](Json &manifest) {
    manifest["contents"]["version"] = {1};
  });
  forge(folder, "endless ranks", [](Json &manifest) {
    manifest["contents"]["ranks"] = 4294967295u;
  });
  forge(folder, "no ranks", [](Json &manifest) { manifest["contents"].erase("ranks"); });
  forge(folder, "half a rank", [](Json &manifest) { manifest["contents"]["ranks"] = 0.5; });
  forge(folder, "another step", [](Json &manifest) { manifest["contents"]["step"] = 7; });
  forge(folder, "no files", [](Json &manifest) { manifest["contents"]["files"] = 3; });
  forge(folder, "a file elsewhere", [](Json &manifest) {
    manifest["contents"]["files"]["../step_0000000004/manifest.json"] = {{"size", 1}, {"crc32", 1}};
  });
  forge(folder, "a file without size", [](Json &manifest) {
    manifest["contents"]["files"]["part.0"].erase("size");
  });
  damage([] {
    std::ofstream("run/checkpoints/step_0000000005/manifest.json") << std::string(1000000, '[');
  });
  report_newest(folder, "a million brackets");

  deallog << "set aside: " << folder.set_aside() << std::endl;
  report(folder, "then");
  deallog << "again: " << folder.set_aside() << std::endl;
  damage([] { std::ofstream("run/checkpoints") << "in the way"; });
  try
    {
      folder.begin(1);
    }
  catch (const RunFailure &failure)
    {
      deallog << failure.details << std::endl;
    }
}
