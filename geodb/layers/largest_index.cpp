// SPDX-License-Identifier: Apache-2.0
#include "geodb/layers/largest_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>

#include "geodb/layers/landmark_search.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

constexpr std::string_view kNameEnd = "_largest";

std::string index_name(std::string_view table, std::string_view column) {
  return fmt::format("{}_{}{}", table, column, kNameEnd);
}

constexpr const char* kKnown = " IS NOT NULL";

std::string comparison(std::string_view column, std::string_view relation, double threshold) {
  return fmt::format("{} {} {:.17g}", quote_identifier(column), relation, threshold);
}

std::string condition_text(std::string_view column, const LargestValues::Threshold& threshold) {
  using Rows = LargestValues::Threshold::Rows;
  if (threshold.rows == Rows::known) return quote_identifier(column) + kKnown;
  return comparison(column, threshold.rows == Rows::above ? ">" : ">=", threshold.value);
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

LargestValues::Threshold LargestValues::threshold(std::size_t column) const {
  using Rows = Threshold::Rows;
  const auto& [heap, equal] = columns_[column];
  if (heap.size() < capacity_) return {.rows = Rows::known};
  return {.rows = equal > capacity_ ? Rows::above : Rows::from, .value = heap.front()};
}

void add_landmark(LargestValues& values, const LandmarkLayout& layout, const Landmark& landmark) {
  const std::vector<double> numbers = layout.numbers(landmark);
  for (std::size_t i = 0; i < numbers.size(); ++i) values.add(i, numbers[i]);
}

void create_largest_indexes(const sqlite::Database& database, const LandmarkLayout& layout,
                            const LargestValues& values) {
  const std::string& table = layout.type().name;
  const auto columns = layout.columns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string& column = columns[i].name;
    if (number_column(layout, column))
      database.execute(fmt::format("CREATE INDEX {} ON {} ({} DESC) WHERE {}",
                                   quote_identifier(index_name(table, column)), quote_identifier(table),
                                   quote_identifier(column), condition_text(column, values.threshold(i))));
  }
}

bool is_largest_index(std::string_view name) {
  return name.ends_with(kNameEnd);
}

LargestConditions largest_conditions(const sqlite::Database& database, std::string_view table,
                                     std::string_view column) {
  sqlite::Statement row =
      database.prepare("SELECT sql FROM sqlite_schema WHERE type = 'index' AND name = ? AND tbl_name = ?");
  const std::string name = index_name(table, column);
  row.bind_all(name, table);
  if (!row.step()) return {};
  const std::string_view sql = row.text(0);
  const std::string quoted = quote_identifier(column);
  if (sql.ends_with(kKnown)) return {quoted + kKnown, quoted + " IS NULL", true};
  const std::size_t above = sql.rfind("> ");
  const std::size_t number = above == std::string_view::npos ? sql.rfind(">= ") : above;
  if (number == std::string_view::npos) return {};
  double threshold = 0;  // only the number and its relation are taken from the file
  if (std::from_chars(sql.data() + sql.find(' ', number) + 1, sql.data() + sql.size(), threshold).ec !=
      std::errc())
    return {};
  if (above == std::string_view::npos) return {comparison(column, ">=", threshold), ""};
  return {comparison(column, ">", threshold), comparison(column, "=", threshold)};
}

}  // namespace waymark::geodb
