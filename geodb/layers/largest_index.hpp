// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include "core/landmark.hpp"
#include "geodb/sqlite/sqlite.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::geodb {

/// The largest values of each feature among many landmarks, to index these alone: a query for the largest
/// reads thousands of rows of a large map and not all.
class LargestValues {
 public:
  /// Each feature keeps its `capacity` largest values.
  explicit LargestValues(std::size_t features, std::size_t capacity = 10'000)
      : heaps_(features), capacity_(capacity) {}
  void add(const FeatureSet& features);
  /// Returns the smallest of the largest values; `std::nullopt` for a feature with fewer values than
  /// `capacity`.
  std::optional<double> threshold(std::size_t feature) const;

 private:
  std::vector<std::vector<double>> heaps_;  ///< smallest first
  std::size_t capacity_;
};

/// Creates a partial index per feature over the values from its threshold on. Cheap before the rows are
/// inserted.
void create_largest_indexes(const sqlite::Database& database, const LandmarkType& type,
                            const LargestValues& values);

/// Returns the condition of the index on a column, e.g. `"radius" >= 3.5`; empty without such an index.
/// SQLite uses the index if a query has the same condition.
std::string largest_condition(const sqlite::Database& database, std::string_view table,
                              std::string_view column);

}  // namespace waymark::geodb
