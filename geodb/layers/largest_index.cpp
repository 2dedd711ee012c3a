// SPDX-License-Identifier: Apache-2.0
#include "geodb/layers/largest_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>

#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

std::string index_name(std::string_view table, std::string_view column) {
  return fmt::format("{}_{}_largest", table, column);
}

std::string condition_text(std::string_view column, double threshold) {
  return fmt::format("{} >= {:.17g}", quote_identifier(column), threshold);
}

}  // namespace

void LargestValues::add(const FeatureSet& features) {
  for (std::size_t i = 0; i < std::min(heaps_.size(), features.size()); ++i) {
    const double value = features[i].value;
    std::vector<double>& heap = heaps_[i];
    if (!features[i].known() || !std::isfinite(value)) continue;
    if (heap.size() == capacity_) {
      if (value <= heap.front()) continue;
      std::ranges::pop_heap(heap, std::greater{});
      heap.pop_back();
    }
    heap.push_back(value);
    std::ranges::push_heap(heap, std::greater{});
  }
}

std::optional<double> LargestValues::threshold(std::size_t feature) const {
  const std::vector<double>& heap = heaps_[feature];
  return heap.size() == capacity_ ? std::optional(heap.front()) : std::nullopt;
}

void create_largest_indexes(const sqlite::Database& database, const LandmarkType& type,
                            const LargestValues& values) {
  for (std::size_t i = 0; i < type.features.size(); ++i)
    if (const auto threshold = values.threshold(i)) {
      const std::string& column = type.features[i].name;
      database.execute(fmt::format(
          "CREATE INDEX {} ON {} ({}) WHERE {}", quote_identifier(index_name(type.name, column)),
          quote_identifier(type.name), quote_identifier(column), condition_text(column, *threshold)));
    }
}

std::string largest_condition(const sqlite::Database& database, std::string_view table,
                              std::string_view column) {
  sqlite::Statement row =
      database.prepare("SELECT sql FROM sqlite_schema WHERE type = 'index' AND name = ? AND tbl_name = ?");
  const std::string name = index_name(table, column);
  row.bind_all(name, table);
  if (!row.step()) return {};
  const std::string_view sql = row.text(0);
  const std::size_t number = sql.rfind(">= ");
  double threshold = 0;  // only the number is taken from the file
  if (number == std::string_view::npos ||
      std::from_chars(sql.data() + number + 3, sql.data() + sql.size(), threshold).ec != std::errc())
    return {};
  return condition_text(column, threshold);
}

}  // namespace waymark::geodb
