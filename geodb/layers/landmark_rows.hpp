// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/landmark.hpp"
#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/layers/landmark_layout.hpp"
#include "geodb/sqlite/sqlite.hpp"
namespace waymark::geodb {

/// Inserts rows of landmarks into a new table, many by one statement. A statement opens every index of the
/// table, which takes longer than the insertion of a row.
class LandmarkRows {
 public:
  /// `database` and `layout` must outlive it.
  LandmarkRows(const sqlite::Database& database, const LandmarkLayout& layout, std::int32_t srs_id);

  /// Inserts a landmark now or with a later one; it must stay until flush().
  void add(std::int64_t row, const Landmark& landmark);
  /// Inserts the landmarks that wait for their statement.
  void flush();

 private:
  struct Pending {
    std::int64_t row = 0;
    const Landmark* landmark = nullptr;
    PointBlob geometry = {};
  };
  void bind(sqlite::Statement& statement, std::size_t index) const;

  const sqlite::Database* database_;
  const LandmarkLayout* layout_;
  std::int32_t srs_id_;
  std::vector<Pending> pending_;
  std::size_t count_ = 0;     ///< of `pending_` that wait
  sqlite::Statement insert_;  ///< as many rows as `pending_`
};

}  // namespace waymark::geodb
