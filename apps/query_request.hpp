// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <string>
#include <vector>
#include "apps/command.hpp"
#include "geo/crs.hpp"
#include "geodb/map_store.hpp"
namespace waymark {

/// What `waymark query` was asked, as it was typed: coordinates in the CRS of --crs.
struct QueryRequest {
  std::string crs, sensor, largest;
  std::vector<std::string> types, lowest, highest;
  std::vector<double> bbox, near, nearest;
  double min_quality = 0;
  std::int64_t limit = std::numeric_limits<std::int64_t>::max();
};
std::vector<Argument> query_arguments(QueryRequest& request);

/// A request made ready for one map.
class MapQuestion {
 public:
  /// Throws Error{usage}: unknown CRS, sensor or type, a box whose corners are swapped, a radius below 0.
  MapQuestion(const QueryRequest& request, const MapStore& map);

  const Crs& crs() const { return crs_; }  ///< of --crs; the map's where none was given
  const SensorProfile* sensor() const { return query_.sensor; }
  /// In the map's CRS.
  std::vector<Landmark> answer(const MapStore& map) const;
  /// True if the answer is sorted by, and printed with, the distance from a point.
  bool from_point() const { return query_.near || query_.nearest; }
  /// Metres from that point to a landmark of the answer.
  double distance(const MapStore& map, const Landmark& landmark) const;

 private:
  void ask_near(const QueryRequest& request, const MapStore& map);
  void ask_box(const QueryRequest& request, const MapStore& map);

  Crs crs_;
  MapQuery query_;
  std::optional<MapQuery::Box> outline_ = {};  ///< in crs_, where that is not the map's
  std::size_t limit_;
};

}  // namespace waymark
