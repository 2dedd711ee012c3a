// SPDX-License-Identifier: Apache-2.0
#include "importers/standard_input.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <mutex>
#include <vector>

#include "core/error.hpp"
#include "core/nameless_file.hpp"

namespace waymark::importers {
namespace {

constexpr std::size_t kPipePiece = std::size_t{1} << 20;

// Returns an open nameless file.
int create_nameless_file() {
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  const int file = open_nameless_file(folder);
  if (file < 0)
    throw Error(ErrorCode::output, "standard input cannot be copied to a temporary file", folder.string(),
                "set TMPDIR to a folder that may be written");
  return file;
}

void write_whole(int file, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t written = ::write(file, bytes, count);
    if (written <= 0)
      throw Error(ErrorCode::output, "the temporary copy of standard input cannot be written",
                  std::filesystem::temp_directory_path().string(),
                  "the disk may be full: set TMPDIR to a folder with more room");
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
}

std::string copy_standard_input() {
  if (::isatty(STDIN_FILENO) != 0)
    throw Error(ErrorCode::input, "standard input is a terminal, not a file", "/vsistdin/",
                "pipe a raster into the program: cat dem.tif | waymark peaks - -o map.gpkg");
  const int file = create_nameless_file();  // open until the process ends
  std::vector<char> piece(kPipePiece);
  std::size_t total = 0;
  while (const std::size_t count = std::fread(piece.data(), 1, piece.size(), stdin)) {
    write_whole(file, piece.data(), count);
    total += count;
  }
  if (total == 0)
    throw Error(ErrorCode::input, "standard input is empty", "/vsistdin/",
                "the program before the pipe failed");
  return fmt::format("/proc/self/fd/{}", file);
}

}  // namespace

std::string seekable_path(const std::string& path) {
  if (!path.starts_with("/vsistdin")) return path;
  static std::mutex mutex;
  static std::string copy;
  const std::lock_guard lock(mutex);
  if (copy.empty()) copy = copy_standard_input();
  return copy;
}

}  // namespace waymark::importers
