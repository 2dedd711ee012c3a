// SPDX-License-Identifier: Apache-2.0
#include "core/text_file.hpp"

#include <fstream>
#include <sstream>

namespace waymark::inline core {

std::string read_text(const std::filesystem::path& file, std::string_view what, ErrorCode code,
                      std::string_view hint) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  std::error_code unknown;
  const bool folder = std::filesystem::is_directory(file, unknown);
  if (stream && !folder && stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (!stream.is_open() || folder || stream.bad() || text.fail())
    throw Error(code, "cannot read " + std::string(what), file.string(), std::string(hint));
  return std::move(text).str();
}

}  // namespace waymark::inline core
