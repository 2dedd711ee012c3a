// SPDX-License-Identifier: Apache-2.0
#include "workflows/evaluation/scored_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "geodb/map_store.hpp"
#include "importers/tables/table.hpp"
#include "importers/tables/table_number.hpp"
#include "landmarks/sensor_profile.hpp"

namespace waymark::workflows {
namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return text;
}

// Returns true for columns that are no features.
bool is_metadata(const std::string& name) {
  static const std::vector<std::string> names{
      "type", "x",       "y",      "z",     "geom_x",    "geom_y",   "geom_z",      "uid",
      "id",   "images",  "pixels", "shape", "preserved", "diameter", "confidence",  "quality",
      "seen", "visible", "var_x",  "var_y", "cov_xy",    "var_z",    "observations"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Trees of a map: their diameter is a feature, that of the stem; they are as wide as their crowns.
bool has_crown(const std::map<std::string, double>& values) {
  const auto crown = values.find("crown_diameter");
  return crown != values.end() && crown->second > 0 && !values.contains("major");
}

double diameter_of(const std::map<std::string, double>& values) {
  if (has_crown(values)) return values.at("crown_diameter");
  const auto value = [&](std::initializer_list<const char*> names) {
    for (const char* name : names)
      if (const auto found = values.find(name); found != values.end()) return found->second;
    return std::nan("");
  };
  if (const double d = value({"diameter", "diam", "diam_px", "d"}); std::isfinite(d)) return d;
  if (const double r = value({"radius"}); std::isfinite(r)) return 2 * r;
  return std::sqrt(value({"major_axis", "major"}) * value({"minor_axis", "minor"}));
}

testbed::EvaluatedObject thing_of(const std::map<std::string, double>& values, double min_pixels) {
  const auto value = [&](const char* name) -> std::optional<double> {
    const auto found = values.find(name);
    return found == values.end() ? std::nullopt : std::optional(found->second);
  };
  testbed::EvaluatedObject thing;
  for (const char* x : {"x", "x_px", "geom_x"})
    if (const auto v = value(x)) thing.at.x() = *v;
  for (const char* y : {"y", "y_px", "geom_y"})
    if (const auto v = value(y)) thing.at.y() = *v;
  thing.diameter = diameter_of(values);
  for (const auto& [name, number] : values)
    if (!is_metadata(name) || (name == "diameter" && has_crown(values))) thing.features[name] = number;
  thing.confidence = value("confidence"), thing.quality = value("quality");
  if (const auto xx = value("var_x"), yy = value("var_y"), xy = value("cov_xy"); xx && yy && xy)
    thing.covariance = (Eigen::Matrix2d() << *xx, *xy, *xy, *yy).finished();
  thing.ignored = value("images") == 0.0 || value("pixels").value_or(min_pixels) < min_pixels;
  return thing;
}

ScoredTables from_map(const geodb::MapStore& map, const std::string& only, const SensorProfile* sensor) {
  ScoredTables tables;
  for (const LandmarkType& type : map.types()) {
    if (!only.empty() && type.name != only) continue;
    auto& things = tables[type.name];
    geodb::MapQuery query;
    query.types = {type.name};
    for (const Landmark& landmark : map.query(query)) {
      std::map<std::string, double> values{{"x", landmark.position.xyz.x()},
                                           {"y", landmark.position.xyz.y()}};
      for (std::size_t f = 0; f < type.features.size(); ++f)
        if (landmark.features[f].known()) values[type.features[f].name] = landmark.features[f].value;
      testbed::EvaluatedObject thing = thing_of(values, 0);
      for (std::size_t f = 0; f < type.features.size(); ++f)
        if (landmark.features[f].known() && landmark.features[f].variance > 0)
          thing.deviations[type.features[f].name] = std::sqrt(landmark.features[f].variance);
      thing.covariance = landmark.covariance.topLeftCorner<2, 2>();
      thing.confidence = landmark.confidence;
      thing.quality = sensor ? quality_for(*sensor, type, landmark) : quality_of(type, landmark);
      things.push_back(thing);
    }
  }
  return tables;
}

// "c1, c2, c3" of a table without a header.
std::vector<std::string> column_names(const importers::TableHeader& header) {
  std::vector<std::string> names = header.columns;
  for (std::string& name : names) name = lower(name);
  const char* const plain[] = {"x", "y", "diameter"};
  for (std::size_t i = 0; i < names.size() && i < 3; ++i)
    if (names[i] == fmt::format("c{}", i + 1)) names[i] = plain[i];
  return names;
}

ScoredTables from_table(importers::TableSource& table, const std::string& only, double min_pixels) {
  const std::vector<std::string> names = column_names(table.header());
  const auto has = [&](std::initializer_list<const char*> any) {
    return std::any_of(any.begin(), any.end(), [&](const char* name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    });
  };
  if (!has({"x", "x_px", "geom_x"}) || !has({"y", "y_px", "geom_y"}))
    throw Error(ErrorCode::input, "the table has no columns x and y", table.header().path,
                "rename its columns, or make a map of it with `waymark import`");
  ScoredTables tables;
  for (importers::TableRow row; table.next(row);) {
    std::map<std::string, double> values;
    std::string type;
    for (std::size_t i = 0; i < names.size() && i < row.cells.size(); ++i) {
      if (names[i] == "type") type = row.cells[i];
      if (importers::is_missing(row.cells[i])) continue;
      if (const auto number = importers::to_real(row.cells[i], table.header().decimal_comma))
        values[names[i]] = *number;
      else if (is_metadata(names[i]) && names[i] != "type" && names[i] != "shape" && names[i] != "uid")
        throw Error(ErrorCode::input, fmt::format("'{}' is no number (column {})", row.cells[i], names[i]),
                    table.row_location(row));
    }
    const auto has_value = [&](std::initializer_list<const char*> any) {
      return std::ranges::any_of(any, [&](const char* name) { return values.contains(name); });
    };
    if (!has_value({"x", "x_px", "geom_x"}) || !has_value({"y", "y_px", "geom_y"}))
      throw Error(ErrorCode::input, "the row has no position", table.row_location(row),
                  "complete its x and y, or remove it");
    if (only.empty() || type.empty() || type == only)
      tables[type.empty() ? only : type].push_back(thing_of(values, min_pixels));
  }
  return tables;
}

bool is_map(const std::string& path) {
  return lower(path).ends_with(".gpkg");
}

}  // namespace

ScoredTables read_scored_things(const std::string& path, const std::string& type, double min_pixels,
                                const SensorProfile* sensor) {
  if (is_map(path)) return from_map(geodb::MapStore::open(path), type, sensor);
  if (sensor)
    throw Error(ErrorCode::usage, "--sensor weighs the quality of a map, but the result is a table", path,
                "leave out --sensor, or evaluate the map");
  return from_table(*importers::open_table(path, importers::TableFormat::by_name, "", type), type,
                    min_pixels);
}

std::map<std::string, std::pair<std::vector<testbed::EvaluatedObject>, std::vector<testbed::EvaluatedObject>>>
pair_by_type(const ScoredTables& found, const ScoredTables& truth, const std::string& type) {
  const auto only_type = [&](const ScoredTables& tables) {
    if (!type.empty()) return type;
    std::vector<std::string> named;
    for (const auto& [name, things] : tables)
      if (!name.empty() && !things.empty()) named.push_back(name);
    if (named.size() > 1)
      throw Error(ErrorCode::usage, "one table has landmark types and the other does not",
                  fmt::format("types: {}", fmt::join(named, ", ")), "name the type to compare: --type");
    return named.empty() ? std::string("landmarks") : named.front();
  };
  std::map<std::string,
           std::pair<std::vector<testbed::EvaluatedObject>, std::vector<testbed::EvaluatedObject>>>
      pairs;
  for (const auto& [name, things] : truth) {
    auto& pair = pairs[name.empty() ? only_type(found) : name];
    pair.second.insert(pair.second.end(), things.begin(), things.end());
  }
  for (const auto& [name, things] : found) {
    const std::string as = name.empty() ? only_type(truth) : name;
    // Types that the truth lacks cannot be evaluated.
    if (const auto pair = pairs.find(as); pair != pairs.end())
      pair->second.first.insert(pair->second.first.end(), things.begin(), things.end());
  }
  // A map has an empty table for each type that it does not hold.
  std::erase_if(pairs,
                [](const auto& pair) { return pair.second.first.empty() && pair.second.second.empty(); });
  return pairs;
}

}  // namespace waymark::workflows
