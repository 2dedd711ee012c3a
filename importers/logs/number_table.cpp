// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/number_table.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "core/error.hpp"
#include "core/text_file.hpp"

namespace waymark::importers {

std::vector<double> number_table(const std::filesystem::path& file, std::size_t per_row) {
  const std::string text = read_text(file, "the file");
  std::vector<double> numbers;
  const char *at = text.data(), *end = at + text.size();
  std::size_t line = 1;
  bool line_begins = true;
  while (at != end) {
    if (*at == '\n') {
      ++line, ++at, line_begins = true;
    } else if (*at == ' ' || *at == '\t' || *at == '\r' || *at == ',') {
      ++at;
    } else if (line_begins && (*at == '#' || *at == '%')) {
      while (at != end && *at != '\n') ++at;
    } else {
      line_begins = false;
      if (*at == '+') ++at;
      double value = 0;
      const auto [rest, problem] = std::from_chars(at, end, value);
      if (problem != std::errc() || rest == at) {
        const char* word_end = at;
        while (word_end != end && *word_end > ' ' && word_end < at + 30) ++word_end;
        throw Error(ErrorCode::input, fmt::format("'{}' is no number", std::string(at, word_end)),
                    fmt::format("{}, line {}", file.string(), line), "columns of numbers are expected");
      }
      numbers.push_back(value);
      at = rest;
    }
  }
  if (numbers.size() % per_row != 0)
    throw Error(ErrorCode::input, fmt::format("{} numbers do not fill rows of {}", numbers.size(), per_row),
                file.string(), "is the file cut off, or of another format?");
  return numbers;
}

}  // namespace waymark::importers
