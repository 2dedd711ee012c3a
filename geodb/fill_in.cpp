// SPDX-License-Identifier: Apache-2.0
#include "geodb/sql_text.hpp"

namespace waymark {

std::string fill_in(std::string_view text,
                    std::initializer_list<std::pair<std::string_view, std::string_view>> values) {
  std::string filled(text);
  for (const auto& [key, value] : values) {
    const std::string place = "{" + std::string(key) + "}";
    for (std::size_t at = filled.find(place); at != std::string::npos;
         at = filled.find(place, at + value.size()))
      filled.replace(at, place.size(), value);
  }
  return filled;
}

std::string sql_name(std::string_view identifier) {
  std::string out = "\"";
  for (char c : identifier) {
    out += c;
    if (c == '"') out += c;
  }
  return out + '"';
}

}  // namespace waymark
