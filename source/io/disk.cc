// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exceptions.h>
#include <coracle/io/disk.h>

#include <filesystem>
#include <fstream>

namespace coracle
{
void
throw_not_written(const std::string &what_went_wrong)
{
  throw RunFailure("a result could not be written",
                   what_went_wrong,
                   "make room on the disk, and see that the output folder still exists and may be "
                   "written to");
}

void
write_file(const std::string &file_name, const std::string &content)
{
  const std::string beside = file_name + ".part";
  std::ofstream     file(beside, std::ios::binary);
  file.write(content.data(), content.size());
  file.close();
  if (!file)
    throw_not_written(beside + ": it could not be written");

  std::error_code error;
  std::filesystem::rename(beside, file_name, error);
  if (error)
    throw_not_written(file_name + ": " + error.message());
}
} // namespace coracle
