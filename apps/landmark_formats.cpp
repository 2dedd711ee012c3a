// SPDX-License-Identifier: Apache-2.0
#include "apps/landmark_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>

#include "core/printable.hpp"
#include "exporters/formatting.hpp"
#include "exporters/vector/export_columns.hpp"

namespace waymark::apps {
namespace {

using Value = std::function<AttributeValue(const Landmark&)>;

AttributeValue or_null(std::optional<double> value) {
  return value && std::isfinite(*value) ? AttributeValue(*value) : AttributeValue();
}

Value coordinate(int axis) {
  return [axis](const Landmark& landmark) { return or_null(landmark.position.xyz[axis]); };
}

/// Joins columns of one name, by type; a landmark of another type has no value.
Value by_type(std::map<TypeId, Value> values) {
  return [values = std::move(values)](const Landmark& landmark) {
    const auto found = values.find(landmark.type);
    return found == values.end() ? AttributeValue() : found->second(landmark);
  };
}

Value quality_column(const RowContext& context) {
  return [context](const Landmark& landmark) {
    const LandmarkType& type = (*context.types)[landmark.type];
    return or_null(context.sensor ? quality_for(*context.sensor, type, landmark)
                                  : quality_of(type, landmark));
  };
}

bool is_feature(const LandmarkType& type, const std::string& name) {
  return std::ranges::count(type.features, name, &FeatureSpec::name) > 0;
}

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

/// Returns the decimals of a column for people: positions and large lengths in decimetres, lengths below 100
/// m in centimetres, below 2 m in millimetres; other numbers have three.
int decimals(const RowColumn& column, std::span<const Landmark> landmarks, bool degrees) {
  if (column.name == "x" || column.name == "y") return degrees ? 6 : 1;
  if (column.unit != "m") return 3;
  double largest = 0;
  for (const Landmark& landmark : landmarks) {
    const AttributeValue value = column.value(landmark);
    if (const auto* real = std::get_if<double>(&value)) largest = std::max(largest, std::abs(*real));
  }
  return largest < 2 ? 3 : largest < 100 ? 2 : 1;
}

std::string table_cell(const AttributeValue& value, int decimals) {
  const auto* real = std::get_if<double>(&value);
  if (const auto* text = std::get_if<std::string>(&value)) return printable(*text, kMaxCell);
  if (!real) return std::holds_alternative<std::monostate>(value) ? "-" : csv_cell(value);
  return fmt::format("{:.{}f}", *real, decimals);
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

std::vector<RowColumn> row_columns(const std::vector<std::string>& chosen, const RowContext& context) {
  const TypeRegistry& types = *context.types;
  std::vector<RowColumn> columns{
      {"type", "", true,
       [&types](const Landmark& landmark) { return AttributeValue(types[landmark.type].name); }},
      {"uid", "", true, [](const Landmark& landmark) { return AttributeValue(landmark.uid); }},
      {"x", "", true, coordinate(0)},
      {"y", "", true, coordinate(1)},
      {"z", "m", false, coordinate(2)}};
  std::vector<RowColumn> more;
  std::map<std::string, std::map<TypeId, Value>> values;
  for (const std::string& name : chosen) {
    const TypeId id = types.id(name);
    for (const exporters::ExportColumn& column : exporters::export_columns(types[id])) {
      if (column.name == "uid") continue;
      if (!values.contains(column.name))
        more.push_back(
            {column.name,
             column.unit,
             is_feature(types[id], column.name) || column.name == "quality" || column.name == "confidence",
             {}});
      values[column.name][id] = column.name == "quality" ? quality_column(context) : column.value;
    }
  }
  for (RowColumn& column : more) {
    column.value = by_type(std::move(values[column.name]));
    columns.push_back(std::move(column));
  }
  if (context.distance)
    columns.push_back({"distance", "m", true,
                       [context](const Landmark& landmark) { return or_null(context.distance(landmark)); }});
  return columns;
}

void print_table(std::ostream& out, std::span<const RowColumn> columns, std::span<const Landmark> landmarks,
                 const Crs& crs) {
  std::vector<const RowColumn*> brief;
  for (const RowColumn& column : columns)
    if (column.brief) brief.push_back(&column);
  std::vector<std::vector<std::string>> lines(1);
  std::vector<int> places;
  for (const RowColumn* column : brief) {
    lines[0].push_back(heading(*column));
    places.push_back(decimals(*column, landmarks, crs.kind() == CrsKind::geographic));
  }
  for (const Landmark& landmark : landmarks) {
    std::vector<std::string>& line = lines.emplace_back();
    for (std::size_t i = 0; i < brief.size(); ++i)
      line.push_back(table_cell(brief[i]->value(landmark), places[i]));
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
