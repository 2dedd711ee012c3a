// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "core/frames.hpp"
#include "geo/crs.hpp"
#include "importers/tables/table.hpp"
namespace waymark {

/// Where the rows of a table lie, and where in the map.
class TablePlaces {
 public:
  /// The table's CRS: as told, else its own, else degrees on the map's body where its columns are called
  /// longitude and latitude, else the map's. The map's: as told, else the table's. Throws Error{usage} where
  /// neither is known or they are on different bodies.
  TablePlaces(const TableHeader& table, const std::string& table_crs, const std::string& map_crs,
              bool named_degrees);

  const Crs& map_crs() const { return map_; }
  /// Why the position has no place in the map; empty if it has, and it is moved there.
  std::string move_to_map(Point<MapCrs>& position);
  std::vector<std::string> warnings() const;

 private:
  Crs table_ = Crs::local(), map_ = Crs::local();
  std::optional<CrsTransform> transform_;
  bool guessed_ = false;  // the table does not say: it was taken to be in the map's CRS
  std::vector<std::string> notes_;
  std::int64_t places_ = 0, like_degrees_ = 0;
};

}  // namespace waymark
