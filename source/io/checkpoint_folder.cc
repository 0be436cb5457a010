// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/mpi.h>
#include <coracle/base/text_scanner.h>
#include <coracle/io/checkpoint_folder.h>
#include <coracle/io/disk.h>

#include <algorithm>
#include <boost/serialization/utility.hpp>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <zlib.h>

namespace coracle
{
namespace
{
namespace fs = std::filesystem;
using Json   = nlohmann::json;

const std::string prefix = "step_", unfinished = ".tmp", format_name = "coracle checkpoint";

std::string
folder_name(const std::uint64_t step)
{
  char text[32];
  std::snprintf(
    text, sizeof(text), "%s%010llu", prefix.c_str(), static_cast<unsigned long long>(step));
  return text;
}

std::uint64_t
checksum_of(const std::string &text)
{
  return crc32(crc32(0, nullptr, 0), reinterpret_cast<const Bytef *>(text.data()), text.size());
}

/// System calls that must succeed, told by name.
void
must(const std::error_code &error, const std::string &name)
{
  if (error)
    throw_not_written(name + ": " + error.message());
}

void
rename(const std::string &from, const std::string &to)
{
  std::error_code error;
  fs::rename(from, to, error);
  must(error, to);
}

/// Nothing of ours is as deep: what is, is none, and would be hard to print and to delete.
Json
parse(const std::string &text)
{
  constexpr int deepest  = 6;
  bool          too_deep = false;
  const Json    result   = Json::parse(
    text,
    [&too_deep](const int depth, const Json::parse_event_t, const Json &) {
      too_deep = too_deep || depth > deepest;
      return !too_deep;
    },
    false);
  return too_deep ? Json() : result;
}

/// Empty, or why the manifest cannot be trusted; then its contents.
std::string
read_manifest(const std::string &file, Json &contents)
try
  {
    const Json manifest = parse(read_whole_file(file));
    if (!manifest.is_object() ||
        manifest.at("crc32").get<std::uint64_t>() != checksum_of(manifest.at("contents").dump()))
      return file + ": damaged";
    contents = manifest["contents"];
    if (contents.at("format") != format_name ||
        contents.at("version") != CheckpointFolder::format_version)
      return file + ": written by another version of the program (format " +
             contents.at("version").dump() + " instead of " +
             std::to_string(CheckpointFolder::format_version) + ")";
    return "";
  }
catch (const FileError &error)
  {
    return error.what();
  }
catch (const Json::exception &)
  {
    return file + ": damaged";
  }

/// Throws an exception of Json's where they are none; the rest of what is wrong is empty or told.
std::string
read_facts(const Json &contents, const std::string &name, CheckpointFolder::Facts &facts)
{
  for (const char *const fact : {"dimension", "ranks", "step"})
    if (!contents.at(fact).is_number_unsigned())
      return std::string("'") + fact + "' is no number";
  facts = {contents.at("dimension"),
           contents.at("ranks"),
           contents.at("step"),
           contents.at("time")};
  if (folder_name(facts.step) != name)
    return "it is of another step, " + std::to_string(facts.step);
  // One at least of each rank: there are not more ranks than the manifest is long.
  const Json &files = contents.at("files");
  if (!files.is_object() || facts.n_ranks == 0 || files.size() < facts.n_ranks)
    return std::to_string(files.size()) + " files of " + std::to_string(facts.n_ranks) + " ranks";
  for (const auto &[file, expected] : files.items())
    if (fs::path(file).filename() != file || !expected.at("size").is_number_unsigned() ||
        !expected.at("crc32").is_number_unsigned())
      return "a file that cannot be in it";
  return "";
}

/// Empty, or what is wrong with a file.
std::string
check_file(const std::string &folder, const std::string &name, const Json &expected)
{
  std::uint64_t size = 0, checksum = 0;
  if (!measure_file(folder + "/" + name, size, checksum))
    return name + ": cannot be read";
  if (size != expected["size"].get<std::uint64_t>())
    return name + ": " + std::to_string(size) + " bytes instead of " +
           std::to_string(expected["size"].get<std::uint64_t>());
  if (checksum != expected["crc32"].get<std::uint64_t>())
    return name + ": damaged (its checksum is not that of the manifest)";
  return "";
}
} // namespace

CheckpointFolder::CheckpointFolder(const std::string &output_directory, MPI_Comm communicator)
  : folder(output_directory + "/checkpoints"), comm(communicator)
{}

std::string
CheckpointFolder::begin(const std::uint64_t step)
{
  current = folder + "/" + folder_name(step);
  mpi::agree(
    [&] {
      if (mpi::rank(comm) != 0)
        return;
      std::error_code error;
      if (fs::is_directory(folder, error))
        for (const auto &entry : fs::directory_iterator(folder, error))
          if (entry.path().extension() == unfinished)
            fs::remove_all(entry.path(), error);
      fs::create_directories(current + unfinished, error);
      must(error, current + unfinished);
    },
    comm);
  return current + unfinished;
}

void
CheckpointFolder::commit(const Facts                    &facts,
                         const std::vector<std::string> &files,
                         const unsigned int              n_kept)
{
  using Measured               = std::pair<std::string, std::pair<std::uint64_t, std::uint64_t>>;
  const std::string     beside = current + unfinished;
  std::vector<Measured> mine;
  mpi::agree(
    [&] {
      for (const std::string &name : files)
        {
          mine.push_back({name, {0, 0}});
          if (!measure_file(beside + "/" + name,
                            mine.back().second.first,
                            mine.back().second.second))
            throw_not_written(beside + "/" + name + ": it cannot be read back");
        }
    },
    comm);
  const auto of_ranks = dealii::Utilities::MPI::gather(comm, mine, 0);
  mpi::agree(
    [&] {
      if (mpi::rank(comm) != 0)
        return;
      Json contents = {{"format", format_name},
                       {"version", format_version},
                       {"dimension", facts.dimension},
                       {"ranks", facts.n_ranks},
                       {"step", facts.step},
                       {"time", facts.time}};
      for (const auto &list : of_ranks)
        for (const auto &[name, measured] : list)
          contents["files"][name] = {{"size", measured.first}, {"crc32", measured.second}};
      const std::string text =
        Json({{"contents", contents}, {"crc32", checksum_of(contents.dump())}}).dump(2) + "\n";
      write_durable(beside + "/manifest.json", {text.begin(), text.end()});
      make_durable(beside);
      if (fs::exists(current))
        rename(current, current + ".replaced" + unfinished);
      rename(beside, current);
      make_durable(folder);
      remove_old(n_kept);
    },
    comm);
}

void
CheckpointFolder::abandon()
{
  std::error_code ignored;
  if (mpi::rank(comm) == 0)
    fs::remove_all(current + unfinished, ignored);
  MPI_Barrier(comm);
}

std::vector<std::string>
CheckpointFolder::list() const
{
  std::vector<std::string> names;
  std::error_code          ignored;
  if (fs::is_directory(folder, ignored))
    for (const auto &entry : fs::directory_iterator(folder, ignored))
      {
        const std::string name = entry.path().filename().string();
        if (name.compare(0, prefix.size(), prefix) == 0 && name.size() > prefix.size() &&
            name.find_first_not_of("0123456789", prefix.size()) == std::string::npos)
          names.push_back(name);
      }
  std::sort(names.rbegin(), names.rend());
  return names;
}

void
CheckpointFolder::remove_old(const unsigned int n_kept) const
{
  const auto      names = list();
  std::error_code ignored;
  fs::remove_all(current + ".replaced" + unfinished, ignored);
  for (unsigned int i = n_kept; i < names.size(); ++i)
    {
      // Not half of it may be found under its name.
      const std::string old = folder + "/" + names[i];
      fs::rename(old, old + unfinished, ignored);
      fs::remove_all(old + unfinished, ignored);
    }
}

std::string
CheckpointFolder::check(const std::string &name, Facts &facts) const
{
  const std::string path = folder + "/" + name;
  Json              contents;
  std::string       problem = read_manifest(path + "/manifest.json", contents);
  try
    {
      if (problem.empty())
        problem = read_facts(contents, name, facts);
      // Shared out, because checksums take as long as reading.
      unsigned int i = 0;
      if (problem.empty())
        for (const auto &[file, expected] : contents["files"].items())
          if (i++ % mpi::n_ranks(comm) == mpi::rank(comm) && problem.empty())
            problem = check_file(path, file, expected);
    }
  catch (const Json::exception &)
    {
      problem = path + "/manifest.json: damaged";
    }
  for (const std::string &other : dealii::Utilities::MPI::all_gather(comm, problem))
    if (!other.empty())
      return other;
  return "";
}

std::optional<CheckpointFolder::Saved>
CheckpointFolder::newest_good(std::vector<std::string> &complaints) const
{
  const auto names = mpi::on_root<std::vector<std::string>>([&] { return list(); }, comm);
  for (const std::string &name : names)
    {
      Saved             saved{folder + "/" + name, {}};
      const std::string problem = check(name, saved.facts);
      if (problem.empty())
        return saved;
      complaints.push_back(saved.path + " cannot be used: " + problem);
    }
  return {};
}

bool
CheckpointFolder::set_aside()
{
  bool any = false;
  if (mpi::rank(comm) == 0 && !list().empty())
    {
      std::error_code ignored;
      fs::remove_all(folder + ".old", ignored);
      fs::rename(folder, folder + ".old", ignored);
      any = true;
    }
  return mpi::any(any, comm);
}
} // namespace coracle
