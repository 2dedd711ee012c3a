// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/rule_expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
#include "importers/tables/table_number.hpp"

namespace waymark::importers {
namespace {

struct LengthUnit {
  std::string_view word;
  double metres;
};
constexpr std::array<LengthUnit, 9> kLengthUnits = {{{"m", 1},
                                                     {"metres", 1},
                                                     {"meters", 1},
                                                     {"km", 1000},
                                                     {"cm", 0.01},
                                                     {"mm", 0.001},
                                                     {"ft", 0.3048},
                                                     {"'", 0.3048},
                                                     {"\"", 0.0254}}};

/// Returns the names in an expression: what is quoted, and words that are no function and not pi.
std::vector<std::string> names_in(const std::string& text) {
  const auto is_word = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return std::isalnum(byte) || c == '_' || byte >= 0x80;
  };
  std::vector<std::string> names;
  for (std::size_t i = 0; i < text.size();) {
    std::string name;
    if (text[i] == '"' || text[i] == '`') {
      const std::size_t end = text.find(text[i], i + 1);
      if (end == std::string::npos) break;
      name = text.substr(i + 1, end - i - 1);
      i = end + 1;
    } else if (is_word(text[i])) {
      const std::size_t start = i;
      while (i < text.size() && (is_word(text[i]) || (text[i] == '.' && std::isdigit(text[start])))) ++i;
      const std::size_t next = text.find_first_not_of(" \t", i);
      const bool call = next != std::string::npos && text[next] == '(';
      if (!call && !std::isdigit(static_cast<unsigned char>(text[start])))
        name = text.substr(start, i - start);
    } else {
      ++i;
    }
    if (!name.empty() && name != "pi" && std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names;
}

/// A row of tags has no table behind it; its cells are numbers or empty.
class NoTable final : public TableSource {
 public:
  const TableHeader& header() const override { return header_; }
  bool next(TableRow& /*row*/) override { return false; }

 private:
  TableHeader header_;
};

}  // namespace

std::optional<double> parse_tag_number(const std::string& text) {
  if (const auto number = to_real(text, true)) return number;
  if (const std::size_t feet = text.find('\''); feet != std::string::npos && text.ends_with('"')) {  // 6'3"
    const auto whole = to_real(text.substr(0, feet), true);
    const auto inches = to_real(text.substr(feet + 1, text.size() - feet - 2), true);
    if (!whole || !inches || *inches < 0) return {};
    return *whole * 0.3048 + *inches * 0.0254;
  }
  const std::size_t end = text.find_last_of("0123456789.,");
  if (end == std::string::npos) return {};
  const std::size_t word = text.find_first_not_of(" \t", end + 1);
  if (word == std::string::npos) return {};
  const std::string_view unit = std::string_view(text).substr(word);
  const auto* found = std::ranges::find(kLengthUnits, unit, &LengthUnit::word);
  const auto number = to_real(text.substr(0, end + 1), true);
  if (found == kLengthUnits.end() || !number) return {};
  return *number * found->metres;
}

RuleExpression::RuleExpression(const std::string& text) : names_(names_in(text)), expression_(text, names_) {}

double RuleExpression::value(const std::map<std::string, std::string>& tags) const {
  static const NoTable table;
  TableRow row;
  for (const std::string& name : names_) {
    const auto tag = tags.find(name);
    const auto number = tag == tags.end() ? std::nullopt : parse_tag_number(tag->second);
    row.cells.push_back(number ? fmt::format("{}", *number) : "");
  }
  return expression_.value(row, table);
}

}  // namespace waymark::importers
