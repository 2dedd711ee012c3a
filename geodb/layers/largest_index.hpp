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

/// The largest values of some columns among many landmarks, to index these alone: a query for the largest
/// reads thousands of rows of a large map and not all.
class LargestValues {
 public:
  /// Smallest of the largest values of a column. `many_equal`: so many landmarks have just this value that
  /// only larger ones are worth an index; a scan in the order of rows soon finds enough of them.
  struct Threshold {
    double value = 0;
    bool many_equal = false;
  };

  /// Each column keeps its `capacity` largest values.
  explicit LargestValues(std::size_t columns, std::size_t capacity = 10'000)
      : columns_(columns), capacity_(capacity) {}
  /// Adds a value of a column; ignores NaN and infinity.
  void add(std::size_t column, double value);
  /// Returns `std::nullopt` for a column with fewer values than `capacity`.
  std::optional<Threshold> threshold(std::size_t column) const;

 private:
  struct Column {
    std::vector<double> heap = {};  ///< smallest first
    std::size_t equal = 0;          ///< values outside the heap that equal its smallest
  };
  std::vector<Column> columns_;
  std::size_t capacity_;
};

/// Returns the columns with an index of their largest values: the type's features, quality and confidence.
std::vector<std::string> largest_columns(const LandmarkType& type);

/// Adds a landmark's values of `largest_columns`.
void add_landmark(LargestValues& values, const LandmarkType& type, const Landmark& landmark);

/// Creates a partial index per column over the values from its threshold on. Cheap before the rows are
/// inserted.
void create_largest_indexes(const sqlite::Database& database, const LandmarkType& type,
                            const LargestValues& values);

/// Conditions of the rows with the largest values of a column, the larger ones first. SQLite uses the index
/// if a query has the condition `indexed`.
struct LargestConditions {
  std::string indexed;  ///< e.g. `"radius" >= 3.5`; empty: no such index
  std::string equal;    ///< rows of equal value that follow, e.g. `"confidence" = 1`; empty: none
};
LargestConditions largest_conditions(const sqlite::Database& database, std::string_view table,
                                     std::string_view column);

}  // namespace waymark::geodb
