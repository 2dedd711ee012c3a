// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/text_table.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "core/error.hpp"
#include "importers/json_value.hpp"

namespace waymark::importers {
namespace {

std::vector<std::string> words_of(std::string_view line) {
  constexpr std::string_view kBlank = " \t\r", kMark = ",;";
  std::vector<std::string> words;
  bool after_mark = true;  // two separators in a row enclose an empty word
  for (std::size_t i = 0; i < line.size();) {
    if (kBlank.find(line[i]) != kBlank.npos) {
      ++i;
    } else if (kMark.find(line[i]) != kMark.npos) {
      if (after_mark) words.emplace_back();
      after_mark = true;
      ++i;
    } else if (line[i] == '"' || line[i] == '\'') {
      const std::size_t end = std::min(line.find(line[i], i + 1), line.size());
      words.emplace_back(line.substr(i + 1, end - i - 1));
      after_mark = false;
      i = end + 1;
    } else {
      const std::size_t end = std::min(line.find_first_of(" \t\r,;", i), line.size());
      words.emplace_back(line.substr(i, end - i));
      after_mark = false;
      i = end;
    }
  }
  return words;
}

}  // namespace

std::vector<TextRow> text_rows(const std::string& path) {
  const std::string content = read_vsi_text(path);
  std::vector<TextRow> rows;
  std::size_t line = 0;
  for (std::size_t begin = content.starts_with("\xEF\xBB\xBF") ? 3 : 0; begin < content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    const std::string_view text = std::string_view(content).substr(begin, end - begin);
    begin = end + 1;
    ++line;
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == text.npos || text[first] == '#') continue;
    rows.push_back({line, words_of(text)});
  }
  return rows;
}

bool parse_number(std::string_view word, double& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return !word.empty() && error == std::errc{} && end == word.data() + word.size();
}

void refuse_line(const std::string& path, std::size_t line, const std::string& problem,
                 const std::string& hint) {
  throw Error(ErrorCode::input, problem, fmt::format("{}, line {}", path, line), hint);
}

double number_at(const TextRow& row, std::size_t index, const std::string& path, const char* name) {
  double value = 0;
  if (index >= row.words.size())
    refuse_line(path, row.line, fmt::format("{} is missing: the line has {} words", name, row.words.size()));
  if (!parse_number(row.words[index], value) || !std::isfinite(value))
    refuse_line(path, row.line, fmt::format("{} must be a number, is '{}'", name, row.words[index]));
  return value;
}

}  // namespace waymark::importers
