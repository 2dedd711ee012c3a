// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include "core/feature.hpp"
#include "core/frames.hpp"
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "importers/tables/area_of_interest.hpp"
#include "importers/tables/table.hpp"
namespace waymark::importers {

/// Axes along which a table states covariances and angles.
enum class AngleReference { table, true_north };

/// Transforms the positions of a table to the map.
class TablePositions {
 public:
  /// Chooses the two CRSs.
  /// - The table's: `table_crs`, else its own, else degrees on the map's body if its columns are named
  ///   longitude and latitude, else the map's.
  /// - The map's: `map_crs`, else the table's.
  /// Throws Error{usage} if neither is known or they are on different bodies.
  TablePositions(const TableHeader& table, const std::string& table_crs, const std::string& map_crs,
                 bool named_degrees);

  const Crs& map_crs() const { return map_; }
  /// Rejects positions outside the polygons of a file, in any CRS of the body. Throws as
  /// read_area_of_interest().
  void keep_inside(const std::string& aoi);
  /// Transforms the position. Returns the reason if that is impossible or it is unwanted, else an empty text.
  std::string transform_to_map(Point<MapCrs>& position);
  /// Transforms the position, the covariance and the angles among the features, likewise.
  std::string transform_to_map(Landmark& landmark, std::span<const FeatureSpec> specs, AngleReference angles);
  std::vector<std::string> warnings() const;

 private:
  double rotation_to_map(const Point<MapCrs>& of_table, AngleReference angles) const;

  Crs table_ = Crs::local(), map_ = Crs::local();
  std::optional<CrsTransform> transform_;
  std::optional<CrsTransform> to_degrees_;  // of the table, if its axes are not east and north
  std::optional<Area> area_;                // in the map's CRS
  bool guessed_ = false;                    // the table names no CRS: the map's is assumed
  std::vector<std::string> notes_;
  std::int64_t positions_ = 0, like_degrees_ = 0;
};

}  // namespace waymark::importers
