// SPDX-License-Identifier: Apache-2.0
#include "core/text_file.hpp"

#include <fstream>
#include <sstream>

namespace waymark::inline core {
namespace {

/// A device such as /dev/zero has no end. Nobody types more than this on a terminal.
constexpr std::size_t kMaxDeviceBytes = 1 << 20;

std::string read_device(std::istream& stream) {
  std::string text(kMaxDeviceBytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

}  // namespace

std::string read_text(const std::filesystem::path& file, std::string_view what, ErrorCode code,
                      std::string_view hint) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  std::error_code unknown;
  const bool folder = std::filesystem::is_directory(file, unknown);
  if (stream && std::filesystem::is_character_file(file, unknown)) {
    std::string content = read_device(stream);
    if (content.size() > kMaxDeviceBytes)
      throw Error(code, "cannot read " + std::string(what) + ": the device does not end", file.string(),
                  std::string(hint));
    return content;
  }
  if (stream && !folder && stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (!stream.is_open() || folder || stream.bad() || text.fail())
    throw Error(code, "cannot read " + std::string(what), file.string(), std::string(hint));
  return std::move(text).str();
}

}  // namespace waymark::inline core
