// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/store/parts_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "pipeline/engine/sha256.hpp"

namespace waymark::pipeline {
namespace {

/// Descriptor that is closed with its last owner.
class OpenFile {
 public:
  OpenFile(const std::filesystem::path& path, int flags)
      : file_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (file_ < 0) fail();
  }
  ~OpenFile() { ::close(file_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ::ssize_t wrote = ::write(file_, bytes.data(), bytes.size());
      if (wrote < 0 && errno != EINTR) fail();
      if (wrote > 0) bytes.remove_prefix(static_cast<std::size_t>(wrote));
    }
  }
  void read(char* to, std::size_t size, std::uint64_t begin) const {
    for (std::size_t done = 0; done < size;) {
      const ::ssize_t got = ::pread(file_, to + done, size - done, static_cast<::off_t>(begin + done));
      if (got == 0) throw std::runtime_error("the file is too short");
      if (got < 0 && errno != EINTR) fail();
      if (got > 0) done += static_cast<std::size_t>(got);
    }
  }
  std::uint64_t size() const {
    struct ::stat status {};
    if (::fstat(file_, &status) != 0) fail();
    return static_cast<std::uint64_t>(status.st_size);
  }

 private:
  [[noreturn]] static void fail() { throw std::system_error(errno, std::generic_category()); }
  int file_;
};

constexpr std::uint64_t kWord = sizeof(std::uint64_t);

}  // namespace

std::string write_parts(const std::filesystem::path& file, const EncodedParts& parts) {
  OpenFile out(file, O_WRONLY | O_CREAT | O_TRUNC);
  Sha256 sum;
  const auto put = [&](std::string_view bytes) { out.write(bytes), sum.add(bytes); };
  std::vector<std::uint64_t> header{parts.all.size()};
  for (const EncodedParts::Part& part : parts.all) header.push_back(part.bytes);
  put({reinterpret_cast<const char*>(header.data()), header.size() * kWord});
  for (const EncodedParts::Part& part : parts.all) put(part.read());
  return sum.hex();
}

EncodedParts open_parts(const std::filesystem::path& file) {
  const auto in = std::make_shared<OpenFile>(file, O_RDONLY);
  const std::uint64_t size = in->size();
  std::uint64_t count = 0;
  in->read(reinterpret_cast<char*>(&count), kWord, 0);
  if (count > size / kWord) throw std::runtime_error("the file is too short");
  std::vector<std::uint64_t> lengths(count);
  in->read(reinterpret_cast<char*>(lengths.data()), count * kWord, kWord);
  EncodedParts parts;
  std::uint64_t begin = (1 + count) * kWord;
  for (const std::uint64_t length : lengths) {
    if (length > size - begin) throw std::runtime_error("the file is too short");
    parts.all.push_back({length, [in, begin, length] {
                           std::string bytes(length, '\0');
                           in->read(bytes.data(), length, begin);
                           return bytes;
                         }});
    begin += length;
  }
  if (begin != size) throw std::runtime_error("the file is too long");
  return parts;
}

}  // namespace waymark::pipeline
