// SPDX-License-Identifier: Apache-2.0
#include "apps/landmark_formats.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>

#include "core/printable.hpp"
#include "exporters/formatting.hpp"

namespace waymark::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxCell = 200;  // bytes of a text in a table for people

Json json_of(const AttributeValue& value) {
  return std::visit(
      [](const auto& held) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::monostate>)
          return nullptr;
        else
          return held;
      },
      value);
}

std::string csv_cell(const AttributeValue& value) {
  if (const auto* real = std::get_if<double>(&value)) return fmt::format("{}", *real);
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *integer);
  if (const auto* text = std::get_if<std::string>(&value)) return exporters::csv_text(*text);
  return "";
}

/// Rounds degrees and metres to about a decimetre, other numbers to three places.
std::string table_cell(const RowColumn& column, const AttributeValue& value, bool degrees) {
  const auto* real = std::get_if<double>(&value);
  if (const auto* text = std::get_if<std::string>(&value)) return printable(*text, kMaxCell);
  if (!real) return std::holds_alternative<std::monostate>(value) ? "-" : csv_cell(value);
  const bool position = column.name == "x" || column.name == "y";
  return fmt::format("{:.{}f}", *real, position && degrees ? 6 : position || column.unit == "m" ? 1 : 3);
}

std::string heading(const RowColumn& column) {
  return column.unit.empty() ? column.name : column.name + " [" + column.unit + "]";
}

void print_line(std::ostream& out, const std::vector<std::string>& cells,
                const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i)
    line +=
        i < 2 ? fmt::format("{:<{}}  ", cells[i], widths[i]) : fmt::format("{:>{}}  ", cells[i], widths[i]);
  line.erase(line.find_last_not_of(' ') + 1);
  out << line << '\n';
}

double rounded(double degrees) {
  return std::round(degrees * 1e9) / 1e9;
}  // 0.1 mm, and no 8.100000000000001

}  // namespace

void print_table(std::ostream& out, std::span<const RowColumn> columns, std::span<const Landmark> landmarks,
                 const Crs& crs) {
  std::vector<const RowColumn*> brief;
  for (const RowColumn& column : columns)
    if (column.brief) brief.push_back(&column);
  std::vector<std::vector<std::string>> lines(1);
  for (const RowColumn* column : brief) lines[0].push_back(heading(*column));
  for (const Landmark& landmark : landmarks) {
    std::vector<std::string>& line = lines.emplace_back();
    for (const RowColumn* column : brief)
      line.push_back(table_cell(*column, column->value(landmark), crs.kind() == CrsKind::geographic));
  }
  std::vector<std::size_t> widths(brief.size());
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  for (const auto& line : lines) print_line(out, line, widths);
}

void print_csv(std::ostream& out, std::span<const RowColumn> columns, std::span<const Landmark> landmarks) {
  for (std::size_t i = 0; i < columns.size(); ++i) out << (i ? "," : "") << columns[i].name;
  out << '\n';
  for (const Landmark& landmark : landmarks) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      out << (i ? "," : "") << csv_cell(columns[i].value(landmark));
    out << '\n';
  }
}

void print_json(std::ostream& out, std::span<const RowColumn> columns, std::span<const Landmark> landmarks) {
  const char* before = "\n";
  out << '[';
  for (const Landmark& landmark : landmarks) {
    Json object = Json::object();
    for (const RowColumn& column : columns) object[column.name] = json_of(column.value(landmark));
    out << before << object.dump(-1, ' ', false, Json::error_handler_t::replace);
    before = ",\n";
  }
  out << "\n]\n";
}

void print_geojson(std::ostream& out, std::span<const RowColumn> columns,
                   std::span<const Landmark> landmarks) {
  const char* before = "\n";
  out << R"({"type": "FeatureCollection", "features": [)";
  for (const Landmark& landmark : landmarks) {
    const auto& at = landmark.position.xyz;
    Json coordinates{rounded(std::remainder(at.x(), 360)), rounded(at.y())};
    if (std::isfinite(at.z())) coordinates.push_back(at.z());
    Json properties = Json::object();
    for (const RowColumn& column : columns)
      if (column.name != "x" && column.name != "y" && column.name != "z")
        properties[column.name] = json_of(column.value(landmark));
    const Json feature{{"type", "Feature"},
                       {"id", landmark.uid},
                       {"geometry", {{"type", "Point"}, {"coordinates", coordinates}}},
                       {"properties", properties}};
    out << before << feature.dump(-1, ' ', false, Json::error_handler_t::replace);
    before = ",\n";
  }
  out << "\n]}\n";
}

}  // namespace waymark::apps
