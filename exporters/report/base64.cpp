// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/base64.hpp"

#include <cstdint>

namespace waymark::exporters {

std::string base64(std::string_view bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  const auto byte = [&](std::size_t i) {
    return i < bytes.size() ? std::uint32_t{static_cast<unsigned char>(bytes[i])} : std::uint32_t{0};
  };
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::uint32_t triple = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    text += letters[triple >> 18];
    text += letters[triple >> 12 & 63];
    text += i + 1 < bytes.size() ? letters[triple >> 6 & 63] : '=';
    text += i + 2 < bytes.size() ? letters[triple & 63] : '=';
  }
  return text;
}

}  // namespace waymark::exporters
