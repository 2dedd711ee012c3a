// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>
#include "geo/crs.hpp"
#include "geodb/map_store.hpp"
namespace waymark::workflows {

/// Conditions on the landmarks of a map. Coordinates are in `crs`.
struct QueryRequest {
  std::string crs;      ///< of coordinates given and returned; empty: the map's
  std::string sensor;   ///< name or file of the profile that weighs the quality; empty: equal weights
  std::string largest;  ///< feature, or other column of numbers, whose largest values come first
  std::vector<std::string> types, min_features, max_features;  ///< bounds: "prominence=300"
  std::vector<double> bbox;                                    ///< min_x, min_y, max_x, max_y
  std::string aoi = {};         ///< file of polygons in any CRS of the body; empty: everywhere
  std::vector<double> near;     ///< x, y, radius in metres
  std::vector<double> nearest;  ///< x, y, count
  double min_quality = 0, min_confidence = 0;
  std::int64_t limit = std::numeric_limits<std::int64_t>::max();
  bool wgs84 = false;  ///< returns longitude and latitude, whatever `crs` says
};

/// Landmarks that meet the conditions of a query.
struct QueryResult {
  TypeRegistry types;                                ///< of the map
  Crs crs;                                           ///< of the landmarks
  std::shared_ptr<const SensorProfile> sensor = {};  ///< null: equal weights
  std::vector<Landmark> landmarks = {};
  std::vector<std::string> why_empty = {};  ///< conditions that no landmark meets, if none is found
  std::unordered_map<std::string, double> distances = {};  ///< metres by uid, of queries about a point
};

/// Returns the landmarks of a map file that meet the conditions. Landmarks without a position in the
/// requested CRS are left out. Throws as PreparedQuery.
QueryResult query(const std::filesystem::path& file, const QueryRequest& request);

/// A request checked against one map.
class PreparedQuery {
 public:
  /// Throws Error{usage}: unknown CRS, sensor or type, a box with swapped corners, a radius below 0.
  PreparedQuery(const QueryRequest& request, const geodb::MapStore& map);

  const Crs& crs() const { return crs_; }  ///< of the request; the map's if it names none
  const std::shared_ptr<const SensorProfile>& sensor() const { return sensor_; }
  /// Returns a sentence for each condition that no landmark of the requested types meets by itself, or one
  /// that none meets all. Costs a query for each condition.
  std::vector<std::string> explain_empty(const geodb::MapStore& map) const;
  /// Returns landmarks in the map's CRS.
  std::vector<Landmark> run(const geodb::MapStore& map) const;
  /// Returns true if the result is sorted by the distance from a point.
  bool from_point() const { return query_.near || query_.nearest; }
  /// Returns metres from that point to a landmark of the result.
  double distance(const geodb::MapStore& map, const Landmark& landmark) const;

 private:
  /// Throws Error{usage} if a number has a least value above its largest.
  void check_bounds() const;
  std::string explain_bound(const geodb::MapStore& map, const geodb::MapQuery::FeatureRange& bound) const;
  void set_centre(const QueryRequest& request, const geodb::MapStore& map);
  void set_box(const QueryRequest& request, const geodb::MapStore& map);

  Crs crs_;
  std::shared_ptr<const SensorProfile> sensor_;
  geodb::MapQuery query_;
  std::optional<geodb::MapQuery::Box> outline_ = {};     ///< in crs_, if that is not the map's
  std::function<bool(double x, double y)> inside_ = {};  ///< in the map's CRS; empty: everywhere
  std::size_t limit_;
};

}  // namespace waymark::workflows
