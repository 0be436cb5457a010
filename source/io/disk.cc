// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/exceptions.h>
#include <coracle/io/disk.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <unistd.h>
#include <zlib.h>

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

namespace
{
/// Closes itself; what goes wrong is told with the system's words.
class Descriptor
{
public:
  Descriptor(const std::string &name, const int flags)
    : name(name), number(::open(name.c_str(), flags, 0666))
  {
    check(number >= 0);
  }
  ~Descriptor()
  {
    if (number >= 0)
      ::close(number);
  }
  Descriptor(const Descriptor &) = delete;

  void write(const char *data, std::size_t size) const
  {
    while (size > 0)
      {
        const ssize_t n = ::write(number, data, std::min(size, std::size_t(1) << 30));
        if (n < 0 && errno == EINTR)
          continue;
        check(n >= 0);
        data += n;
        size -= n;
      }
  }

  void make_durable() const { check(::fsync(number) == 0 || errno == EINVAL); }

  void close()
  {
    const int closed = ::close(number);
    number           = -1;
    check(closed == 0);
  }

private:
  void check(const bool good) const
  {
    if (!good)
      throw_not_written(name + ": " + std::strerror(errno));
  }

  const std::string name;
  int               number;
};
} // namespace

void
make_durable(const std::string &name)
{
  Descriptor(name, O_RDONLY).make_durable();
}

void
write_durable(const std::string &file_name, const std::vector<char> &content)
{
  Descriptor file(file_name, O_WRONLY | O_CREAT | O_TRUNC);
  file.write(content.data(), content.size());
  file.make_durable();
  file.close();
}

bool
measure_file(const std::string &file_name, std::uint64_t &size, std::uint64_t &checksum)
{
  std::ifstream file(file_name, std::ios::binary);
  if (!file)
    return false;
  std::vector<char> buffer(std::size_t(1) << 20);
  size     = 0;
  checksum = crc32(0, nullptr, 0);
  while (file)
    {
      file.read(buffer.data(), buffer.size());
      checksum = crc32(checksum, reinterpret_cast<const Bytef *>(buffer.data()), file.gcount());
      size += file.gcount();
    }
  return file.eof();
}
} // namespace coracle
