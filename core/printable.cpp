// SPDX-License-Identifier: Apache-2.0
#include "core/printable.hpp"

#include <algorithm>

namespace waymark::inline core {
namespace {

std::string escaped_byte(char c) {
  constexpr const char* kDigits = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  return {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
}

/// Returns true for C0 and C1 controls other than line feed and tab, and for U+202A to U+202E and U+2066 to
/// U+2069, which reverse the direction of writing.
bool controls_terminal(std::string_view character) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
  if (character.size() == 1) return (at(0) < 0x20 && at(0) != '\n' && at(0) != '\t') || at(0) == 0x7F;
  if (character.size() == 2) return at(0) == 0xC2 && at(1) < 0xA0;
  return character.size() == 3 && at(0) == 0xE2 &&
         ((at(1) == 0x80 && at(2) >= 0xAA && at(2) <= 0xAE) ||
          (at(1) == 0x81 && at(2) >= 0xA6 && at(2) <= 0xA9));
}

bool is_continuation(char c) {
  return (static_cast<unsigned char>(c) & 0xC0) == 0x80;
}

}  // namespace

std::size_t utf8_length(std::string_view text) {
  if (text.empty()) return 0;
  const auto lead = static_cast<unsigned char>(text[0]);
  std::size_t length = 0;
  if (lead < 0x80)
    length = 1;
  else if (lead >= 0xC2 && lead <= 0xDF)
    length = 2;
  else if (lead >= 0xE0 && lead <= 0xEF)
    length = 3;
  else if (lead >= 0xF0 && lead <= 0xF4)
    length = 4;
  if (length == 0 || text.size() < length) return 0;
  const int low = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
  const int high = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
  for (std::size_t i = 1; i < length; ++i) {
    const int byte = static_cast<unsigned char>(text[i]);
    if (byte < (i == 1 ? low : 0x80) || byte > (i == 1 ? high : 0xBF)) return 0;
  }
  return length;
}

std::string printable(std::string_view text, std::size_t max_bytes) {
  std::string safe;
  safe.reserve(std::min(text.size(), max_bytes));
  const auto append = [&](std::string_view part) {
    while (!part.empty()) {
      const std::size_t length = utf8_length(part);
      const std::string_view character = part.substr(0, std::max<std::size_t>(length, 1));
      if (length == 0 || controls_terminal(character))
        for (const char c : character) safe += escaped_byte(c);
      else
        safe += character;
      part.remove_prefix(character.size());
    }
  };
  if (text.size() <= max_bytes) {
    append(text);
    return safe;
  }
  std::size_t head = max_bytes * 2 / 3, tail = text.size() - max_bytes / 3;
  while (head > 0 && is_continuation(text[head])) --head;
  while (tail < text.size() && is_continuation(text[tail])) ++tail;
  append(text.substr(0, head));
  safe += " ... " + std::to_string(tail - head) + " bytes ... ";
  append(text.substr(tail));
  return safe;
}

}  // namespace waymark::inline core
