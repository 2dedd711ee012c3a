// SPDX-License-Identifier: Apache-2.0
#include "geodb/layers/largest_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>

#include "geodb/sqlite/sql_text.hpp"
#include "landmarks/sensor_profile.hpp"

namespace waymark::geodb {
namespace {

std::string index_name(std::string_view table, std::string_view column) {
  return fmt::format("{}_{}_largest", table, column);
}

std::string condition_text(std::string_view column, std::string_view relation, double threshold) {
  return fmt::format("{} {} {:.17g}", quote_identifier(column), relation, threshold);
}

}  // namespace

void LargestValues::add(std::size_t column, double value) {
  auto& [heap, equal] = columns_[column];
  if (!std::isfinite(value)) return;
  if (heap.size() == capacity_) {
    const double smallest = heap.front();
    equal += value == smallest;
    if (value <= smallest) return;
    std::ranges::pop_heap(heap, std::greater{});
    heap.back() = value;
    std::ranges::push_heap(heap, std::greater{});
    equal = heap.front() == smallest ? equal + 1 : 0;
    return;
  }
  heap.push_back(value);
  std::ranges::push_heap(heap, std::greater{});
}

std::optional<LargestValues::Threshold> LargestValues::threshold(std::size_t column) const {
  const auto& [heap, equal] = columns_[column];
  if (heap.size() < capacity_) return std::nullopt;
  return Threshold{.value = heap.front(), .many_equal = equal > capacity_};
}

std::vector<std::string> largest_columns(const LandmarkType& type) {
  std::vector<std::string> names;
  for (const FeatureSpec& feature : type.features) names.push_back(feature.name);
  names.insert(names.end(), {"quality", "confidence"});
  return names;
}

void add_landmark(LargestValues& values, const LandmarkType& type, const Landmark& landmark) {
  const std::size_t features = type.features.size();
  for (std::size_t i = 0; i < std::min(features, landmark.features.size()); ++i)
    if (landmark.features[i].known()) values.add(i, landmark.features[i].value);
  if (const auto quality = quality_of(type, landmark)) values.add(features, *quality);
  values.add(features + 1, landmark.confidence);
}

void create_largest_indexes(const sqlite::Database& database, const LandmarkType& type,
                            const LargestValues& values) {
  const std::vector<std::string> columns = largest_columns(type);
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (const auto threshold = values.threshold(i))
      database.execute(fmt::format(
          "CREATE INDEX {} ON {} ({} DESC) WHERE {}", quote_identifier(index_name(type.name, columns[i])),
          quote_identifier(type.name), quote_identifier(columns[i]),
          condition_text(columns[i], threshold->many_equal ? ">" : ">=", threshold->value)));
}

LargestConditions largest_conditions(const sqlite::Database& database, std::string_view table,
                                     std::string_view column) {
  sqlite::Statement row =
      database.prepare("SELECT sql FROM sqlite_schema WHERE type = 'index' AND name = ? AND tbl_name = ?");
  const std::string name = index_name(table, column);
  row.bind_all(name, table);
  if (!row.step()) return {};
  const std::string_view sql = row.text(0);
  const std::size_t relation = sql.rfind("> ");
  const std::size_t number = relation == std::string_view::npos ? sql.rfind(">= ") : relation;
  if (number == std::string_view::npos) return {};
  double threshold = 0;  // only the number and its relation are taken from the file
  if (std::from_chars(sql.data() + sql.find(' ', number) + 1, sql.data() + sql.size(), threshold).ec !=
      std::errc())
    return {};
  if (relation == std::string_view::npos) return {condition_text(column, ">=", threshold), ""};
  return {condition_text(column, ">", threshold), condition_text(column, "=", threshold)};
}

}  // namespace waymark::geodb
