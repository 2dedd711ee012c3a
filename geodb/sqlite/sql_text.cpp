// SPDX-License-Identifier: Apache-2.0
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {

std::string substitute_keys(std::string_view text,
                            std::initializer_list<std::pair<std::string_view, std::string_view>> values) {
  std::string filled(text);
  for (const auto& [key, value] : values) {
    const std::string placeholder = "{" + std::string(key) + "}";
    for (std::size_t at = filled.find(placeholder); at != std::string::npos;
         at = filled.find(placeholder, at + value.size()))
      filled.replace(at, placeholder.size(), value);
  }
  return filled;
}

std::string quote_identifier(std::string_view identifier) {
  std::string out = "\"";
  for (char c : identifier) {
    out += c;
    if (c == '"') out += c;
  }
  return out + '"';
}

}  // namespace waymark::geodb
