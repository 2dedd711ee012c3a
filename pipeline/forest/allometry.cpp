// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/allometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.hpp"
#include "core/lower_case.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kBreastHeight = 1.3;

// Cells of a line; quoted cells may contain commas.
std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else if (c != '\r')
      cells.back() += c;
  }
  for (std::string& cell : cells) {
    const auto first = cell.find_first_not_of(" \t");
    cell = first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(" \t") - first + 1);
  }
  return cells;
}

std::optional<double> number(const std::string& cell) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (cell.empty() || error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value))
    return {};
  return value;
}

class Reader {
 public:
  Reader(std::string_view file, const std::vector<std::string>& head) : file_(file) {
    for (const std::string& name : head) names_.push_back(lower_case(name));
  }
  Allometry row(const std::vector<std::string>& cells, int line) const {
    Allometry one;
    one.species = text(cells, "species").empty() ? "all" : text(cells, "species");
    const std::string form = lower_case(text(cells, "form"));
    if (form != "height" && form != "height_crown")
      fail(line, fmt::format("the form is '{}'; it is height or height_crown", form));
    one.form = form == "height" ? AllometryForm::height : AllometryForm::height_crown;
    one.a = needed(cells, "a", line), one.b = needed(cells, "b", line);
    one.sigma = needed(cells, "sigma", line);
    if (!(one.a > 0) || !(one.b > 0) || !(one.sigma >= 0 && one.sigma < 3))
      fail(line, "a and b are positive, sigma lies in [0, 3)");
    one.trees = static_cast<std::int64_t>(number(text(cells, "trees")).value_or(0));
    one.rmse = number(text(cells, "rmse_cm")).value_or(Allometry::kUnknown);
    one.held_out_rmse = number(text(cells, "held_out_rmse_cm")).value_or(Allometry::kUnknown);
    one.held_out_bias = number(text(cells, "held_out_bias_cm")).value_or(Allometry::kUnknown);
    one.source = text(cells, "source");
    return one;
  }

 private:
  std::string text(const std::vector<std::string>& cells, std::string_view name) const {
    const auto found = std::ranges::find(names_, name);
    const auto i = static_cast<std::size_t>(found - names_.begin());
    return i < cells.size() && found != names_.end() ? cells[i] : "";
  }
  double needed(const std::vector<std::string>& cells, const char* name, int line) const {
    if (const auto value = number(text(cells, name))) return *value;
    fail(line, fmt::format("'{}' is no number for {}", text(cells, name), name));
  }
  [[noreturn]] void fail(int line, const std::string& problem) const {
    throw Error(ErrorCode::input, problem, fmt::format("{}, line {}", file_, line),
                "`waymark allometry fit TREES.csv -o TABLE.csv` writes such a table");
  }
  std::string_view file_;
  std::vector<std::string> names_;
};

std::string cell(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}

}  // namespace

std::string to_string(AllometryForm form) {
  return form == AllometryForm::height ? "height" : "height_crown";
}

std::optional<StemDiameter> stem_diameter(const Allometry& allometry, double height, double height_sd,
                                          double crown, double crown_sd) {
  const bool crowned = allometry.form == AllometryForm::height_crown;
  if (!(height > kBreastHeight + 0.01) || (crowned && !(crown > 0))) return {};
  const double x = crowned ? height * crown : height - kBreastHeight;
  const double correction = crowned ? std::exp(allometry.sigma * allometry.sigma / 2) : 1;
  const double centimetres = allometry.a * std::pow(x, allometry.b) * correction;
  double relative = crowned ? std::hypot(height_sd / height, crown_sd / crown) : height_sd / x;
  relative = std::hypot(allometry.b * relative, allometry.sigma);
  if (!std::isfinite(centimetres)) return {};
  return StemDiameter{centimetres / 100, centimetres / 100 * relative};
}

const Allometry* allometry_of(std::span<const Allometry> table, std::string_view species) {
  const Allometry* all = nullptr;
  for (const Allometry& row : table) {
    if (lower_case(row.species) == lower_case(species)) return &row;
    if (lower_case(row.species) == "all") all = &row;
  }
  return all;
}

const std::vector<Allometry>& built_in_allometry() {
  static const std::vector<Allometry> table{{.species = "all",
                                             .form = AllometryForm::height_crown,
                                             .a = 0.557,
                                             .b = 0.809,
                                             .sigma = 0.237,
                                             .source = "Jucker et al. 2017"}};
  return table;
}

std::vector<Allometry> parse_allometry(std::string_view csv, std::string_view file) {
  std::vector<Allometry> table;
  std::optional<Reader> reader;
  int line = 0;
  while (!csv.empty()) {
    const std::size_t end = std::min(csv.find('\n'), csv.size());
    const std::string_view text = csv.substr(0, end);
    csv.remove_prefix(std::min(end + 1, csv.size()));
    ++line;
    if (text.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    if (reader)
      table.push_back(reader->row(cells_of(text), line));
    else
      reader.emplace(file, cells_of(text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text));
  }
  if (table.empty())
    throw Error(ErrorCode::input, "the allometry table has no rows", std::string(file),
                "`waymark allometry fit TREES.csv -o TABLE.csv` writes such a table");
  return table;
}

std::string allometry_as_csv(std::span<const Allometry> table) {
  std::string csv = "species,form,a,b,sigma,trees,rmse_cm,held_out_rmse_cm,held_out_bias_cm,source\n";
  for (const Allometry& row : table) {
    const bool quote = row.species.find_first_of(",\"") != std::string::npos;
    std::string species = row.species;
    std::erase(species, '"');
    csv += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", quote ? '"' + species + '"' : species,
                       to_string(row.form), cell(row.a), cell(row.b), cell(row.sigma), row.trees,
                       cell(row.rmse), cell(row.held_out_rmse), cell(row.held_out_bias), row.source);
  }
  return csv;
}

}  // namespace waymark::pipeline
