// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/landmark_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "exporters/formatting.hpp"
#include "exporters/report/map_markers.hpp"
#include "exporters/report/map_view.hpp"
#include "exporters/vector/export_columns.hpp"

namespace waymark::exporters {
namespace {

/// One column: its heading and the cell of a landmark.
struct TableColumn {
  std::string heading, tip;
  std::function<std::string(const Landmark&)> cell;
};

double real_attribute(const Landmark& landmark, std::size_t i) {
  const double* value =
      i < landmark.attributes.size() ? std::get_if<double>(&landmark.attributes[i]) : nullptr;
  return value != nullptr ? *value : std::numeric_limits<double>::quiet_NaN();
}

double largest(const std::vector<Landmark>& rows, const std::function<double(const Landmark&)>& value) {
  double largest = 0;
  for (const Landmark& row : rows)
    if (const double v = std::abs(value(row)); v > largest) largest = v;
  return largest;
}

std::string with_unit(const std::string& title, const NumberFormat& read) {
  return escape_markup(title) +
         (read.unit.empty() ? "" : fmt::format(" <small>{}</small>", escape_markup(read.unit)));
}

TableColumn feature_column(const LandmarkType& type, std::size_t i, const std::vector<Landmark>& rows) {
  const FeatureSpec& feature = type.features[i];
  const NumberFormat read =
      number_format(feature, largest(rows, [i](const Landmark& l) { return value_of(l, i); }));
  const auto bound = lower_bound_of(type, feature.name);
  return {with_unit(title_of(feature.name), read), feature.summary, [=](const Landmark& l) {
            std::string cell = read.number(value_of(l, i));
            if (!std::isfinite(value_of(l, i))) return cell;
            if (l.features[i].variance > 0)
              cell += fmt::format("<small>\u00b1 {}</small>", read.number(std::sqrt(l.features[i].variance)));
            const double low = bound ? real_attribute(l, *bound) : value_of(l, i);
            if (low < value_of(l, i)) cell += fmt::format("<small>at least {}</small>", read.number(low));
            return cell;
          }};
}

/// Returns false for positions and bounds, shown elsewhere, and for texts, which name other landmarks.
bool is_plain(const LandmarkType& type, const AttributeSpec& attribute) {
  const std::string& name = attribute.name;
  const bool bound =
      name.ends_with("_low") && find_feature(type, name.substr(0, name.size() - 4)).has_value();
  return attribute.kind == AttributeSpec::Kind::real && !bound && !name.ends_with("_x") &&
         !name.ends_with("_y");
}

TableColumn attribute_column(const AttributeSpec& attribute, std::size_t i,
                             const std::vector<Landmark>& rows) {
  const FeatureSpec as_feature{
      .name = attribute.name, .unit = attribute.unit, .scale = Scale::interval, .summary = {}};
  const NumberFormat read =
      number_format(as_feature, largest(rows, [i](const Landmark& l) { return real_attribute(l, i); }));
  return {with_unit(title_of(attribute.name), read), attribute.summary,
          [=](const Landmark& l) { return read.number(real_attribute(l, i)); }};
}

std::vector<TableColumn> table_columns(const LandmarkType& type, const std::vector<Landmark>& rows,
                                       const Crs& crs) {
  std::vector<TableColumn> columns;
  columns.push_back({"Place", "Position in " + crs.id(), [crs](const Landmark& l) {
                       return fmt::format("{}<small>{}</small>",
                                          position_text(crs, l.position.xyz.x(), l.position.xyz.y()),
                                          escape_markup(l.uid));
                     }});
  for (std::size_t i = 0; i < type.features.size(); ++i) columns.push_back(feature_column(type, i, rows));
  for (std::size_t i = 0; i < type.attributes.size(); ++i)
    if (is_plain(type, type.attributes[i])) columns.push_back(attribute_column(type.attributes[i], i, rows));
  columns.push_back({"Confidence", "Probability that it exists",
                     [](const Landmark& l) { return number_text(l.confidence, 2); }});
  columns.push_back(
      {"Quality", "Landmark quality, equal weights; not assessed if seen once of once",
       [](const Landmark& l) { return number_text(equal_weight_quality(l).value_or(std::nan("")), 2); }});
  return columns;
}

std::string rank_text(const LandmarkType& type) {
  if (type.size_feature.empty()) return "";
  return (lower_bound_of(type, type.size_feature) ? ", by certified " : ", by ") +
         escape_markup(type.size_feature);
}

}  // namespace

std::string landmark_table(const LandmarkSection& section, const Crs& crs, std::int64_t top) {
  const auto count =
      std::min(section.landmarks.size(), static_cast<std::size_t>(std::max<std::int64_t>(0, top)));
  if (count == 0) return {};
  const std::vector<Landmark> rows(section.landmarks.begin(),
                                   section.landmarks.begin() + static_cast<std::ptrdiff_t>(count));
  const auto columns = table_columns(section.type, rows, crs);
  std::string html = fmt::format(
      "<div class='scroll'><table class='landmarks'><caption>The foremost {} of {}{}</caption>"
      "<thead><tr><th scope='col'>#</th>",
      count, number_text(static_cast<double>(section.count)), rank_text(section.type));
  for (const TableColumn& column : columns)
    html += fmt::format("<th scope='col' title='{}'>{}</th>", escape_markup(column.tip), column.heading);
  html += "</tr></thead><tbody>\n";
  for (std::size_t i = 0; i < count; ++i) {
    html += fmt::format("<tr {}><th scope='row'>{}</th>", landmark_attributes(rows[i]), i + 1);
    for (const TableColumn& column : columns) html += "<td>" + column.cell(rows[i]) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace waymark::exporters
