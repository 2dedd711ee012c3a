// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>
#include "core/landmark.hpp"
#include "geodb/layers/landmark_layout.hpp"
#include "geodb/sqlite/sqlite.hpp"
namespace waymark::geodb {

/// The largest values of some columns among many landmarks, to index these alone: a query for the largest
/// reads thousands of rows of a large map and not all.
class LargestValues {
 public:
  /// Rows of a column that are worth an index.
  struct Threshold {
    enum class Rows {
      from,   ///< with this value or a larger one
      above,  ///< with a larger one: a scan in the order of rows soon finds enough that have just this value
      known,  ///< with any value: most rows have none
    };
    Rows rows = Rows::from;
    double value = 0;
  };

  /// Keeps the `capacity` largest values of each column.
  explicit LargestValues(std::size_t columns, std::size_t capacity = 10'000)
      : columns_(columns), capacity_(capacity) {}
  /// Adds a value of a column; ignores NaN and infinity.
  void add(std::size_t column, double value);
  Threshold threshold(std::size_t column) const;

 private:
  struct Column {
    std::vector<double> heap = {};  ///< smallest first
    std::size_t equal = 0;          ///< values outside the heap that equal its smallest
  };
  std::vector<Column> columns_;
  std::size_t capacity_;
};

/// Adds a landmark's value of each column of its table.
void add_landmark(LargestValues& values, const LandmarkLayout& layout, const Landmark& landmark);

/// Creates a partial index of each column of numbers, over the rows with its largest values. To be called
/// before a RowInserter fills the table: each index of a full table costs a scan of it.
void create_largest_indexes(const sqlite::Database& database, const LandmarkLayout& layout,
                            const LargestValues& values);

/// Returns whether an index has a name as create_largest_indexes() gives.
bool is_largest_index(std::string_view name);

/// Conditions of the rows with the largest values of a column, the larger ones first. SQLite uses the index
/// if a query has the condition `indexed`.
struct LargestConditions {
  std::string indexed;    ///< e.g. `"radius" >= 3.5`; empty: no such index
  std::string following;  ///< rows of equal rank that follow, e.g. `"quality" IS NULL`; empty: none
  bool all_rows = false;  ///< no other rows exist
};
LargestConditions largest_conditions(const sqlite::Database& database, std::string_view table,
                                     std::string_view column);

}  // namespace waymark::geodb
