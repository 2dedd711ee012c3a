// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/stand_volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numbers>

#include "core/error.hpp"
#include "core/lower_case.hpp"
#include "core/options/option_table.hpp"

namespace waymark::pipeline {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\"";
  const std::size_t from = text.find_first_not_of(blanks);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(blanks) - from + 1);
}

/// Small CSV without quoted commas; columns by name.
class SmallTable {
 public:
  SmallTable(std::string_view csv, std::string_view file, const std::vector<std::string>& known)
      : file_(file) {
    if (csv.starts_with("\xEF\xBB\xBF")) csv.remove_prefix(3);
    int number = 0;
    while (!csv.empty()) {
      const std::size_t end = std::min(csv.find('\n'), csv.size());
      const std::string_view line = trimmed(csv.substr(0, end));
      csv.remove_prefix(std::min(end + 1, csv.size()));
      ++number;
      if (line.empty() || line.starts_with('#')) continue;
      std::vector<std::string> cells = split(line);
      if (names_.empty()) {
        for (std::string& name : cells) names_.push_back(lower_case(name));
        check_names(known);
        continue;
      }
      if (cells.size() != names_.size())
        refuse(number, fmt::format("{} values for {} columns", cells.size(), names_.size()),
               "one value per column, separated by commas");
      lines_.push_back(number);
      rows_.push_back(std::move(cells));
    }
    if (rows_.empty()) refuse(number, "the table has no rows", "the first line names the columns");
  }

  std::size_t rows() const { return rows_.size(); }
  bool has(const std::string& name) const { return std::ranges::count(names_, name) > 0; }
  void require(const std::string& name) const {
    if (!has(name))
      throw Error(ErrorCode::input, fmt::format("the table has no column '{}'", name), file_,
                  fmt::format("its columns are: {}", joined(names_)));
  }
  std::string text(std::size_t row, const std::string& name) const {
    const auto at = std::ranges::find(names_, name) - names_.begin();
    return has(name) ? rows_[row][static_cast<std::size_t>(at)] : "";
  }
  /// Returns `otherwise` if there is no such column or value.
  double number(std::size_t row, const std::string& name, double otherwise, double low, double high) const {
    const std::string word = text(row, name);
    if (word.empty()) return otherwise;
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size())
      refuse(lines_[row], fmt::format("{} is no number: '{}'", name, word), "use a point for decimals");
    const std::string fault = range_fault(
        {.name = name, .unit = "", .value = value, .field = {.help = "", .min = low, .max = high}}, value);
    if (!fault.empty()) refuse(lines_[row], fault, "");
    return value;
  }
  [[noreturn]] void refuse(int line, const std::string& problem, const std::string& hint) const {
    throw Error(ErrorCode::input, problem, fmt::format("{}, line {}", file_, line), hint);
  }
  int line(std::size_t row) const { return lines_[row]; }

 private:
  static std::vector<std::string> split(std::string_view line) {
    std::vector<std::string> cells;
    for (;;) {
      const std::size_t comma = std::min(line.find(','), line.size());
      cells.emplace_back(trimmed(line.substr(0, comma)));
      if (comma == line.size()) return cells;
      line.remove_prefix(comma + 1);
    }
  }
  static std::string joined(const std::vector<std::string>& words) {
    std::string all;
    for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
    return all;
  }
  void check_names(const std::vector<std::string>& known) const {
    for (const std::string& name : names_) {
      const std::string near = nearest_name(name, known);
      if (std::ranges::count(known, name) == 0 && !near.empty())
        throw Error(ErrorCode::input, fmt::format("the table has an unknown column '{}'", name), file_,
                    fmt::format("did you mean '{}'?", near));
    }
  }

  std::string file_;
  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> rows_;
  std::vector<int> lines_;
};

}  // namespace

const std::vector<VolumeRow>& built_in_volume() {
  static const std::vector<VolumeRow> rows{
      {.source = "van Laar & Akca 2007, Forest Mensuration, ch. 7: middle of the usual form factors"}};
  return rows;
}

const VolumeRow* volume_of(std::span<const VolumeRow> table, std::string_view species) {
  for (const std::string& wanted : {lower_case(species), std::string("all")})
    for (const VolumeRow& row : table)
      if (lower_case(row.species) == wanted) return &row;
  return nullptr;
}

double stem_volume(const VolumeRow& row, double diameter, double height) {
  return row.form_factor * std::numbers::pi / 4 * diameter * diameter * height;
}

std::vector<VolumeRow> parse_volume(std::string_view csv, std::string_view file) {
  const SmallTable table(csv, file,
                         {"species", "form_factor", "form_factor_sd", "mass_per_volume", "source"});
  for (const char* name : {"species", "form_factor"}) table.require(name);
  std::vector<VolumeRow> rows;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    VolumeRow row;
    row.species = table.text(i, "species");
    row.form_factor = table.number(i, "form_factor", -1, 0.05, 1);
    if (row.species.empty() || row.form_factor < 0)
      table.refuse(table.line(i), "a row needs a species and a form_factor", "\"all\" is any species");
    row.form_factor_sd = table.number(i, "form_factor_sd", 0, 0, 1);
    row.mass_per_volume = table.number(i, "mass_per_volume", row.mass_per_volume, 1, 5000);
    row.source = table.text(i, "source");
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<RecallRow> parse_recall(std::string_view csv, std::string_view file) {
  const SmallTable table(csv, file, {"height_from", "recall", "sd"});
  for (const char* name : {"height_from", "recall"}) table.require(name);
  std::vector<RecallRow> rows;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    RecallRow row;
    row.height_from = table.number(i, "height_from", 0, 0, 200);
    row.recall = table.number(i, "recall", -1, 0.01, 1);
    if (row.recall < 0)
      table.refuse(table.line(i), "a row needs a recall", "the fraction of trees detected, 0.01 to 1");
    row.sd = table.number(i, "sd", 0, 0, 1);
    if (!rows.empty() && !(row.height_from > rows.back().height_from))
      table.refuse(table.line(i), "height_from does not rise", "sort the rows by height");
    rows.push_back(row);
  }
  return rows;
}

}  // namespace waymark::pipeline
