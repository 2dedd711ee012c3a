// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include "core/landmark.hpp"
#include "core/units.hpp"
#include "geo/local_frame.hpp"
#include "landmarks/landmark_type.hpp"
#include "landmarks/sensor_profile.hpp"
namespace waymark::inline landmarks {

/// Conditions of a query on landmarks.
struct LandmarkFilter {
  std::string type = {};                  ///< empty: all types
  double min_quality = 0;                 ///< 0 accepts landmarks of unknown quality too
  const SensorProfile* sensor = nullptr;  ///< sensor that weights the quality (eq. 8); null: equal weights
};

/// Box in the map's CRS, edges included. In degrees, west > east crosses the antimeridian.
struct MapBox {
  double west = 0, south = 0, east = 0, north = 0;
};

/// Semantic map in memory, immutable and thread-safe; copies share the landmarks. Distances are horizontal,
/// in metres: geodesics on the body's ellipsoid, also across the antimeridian and the poles; planar in a
/// local CRS.
class SemanticMap {
 public:
  /// Result of a query, e.g. `for (const Landmark& rock : map.near(...))`. Valid while a copy of the map
  /// exists.
  using LandmarkRefs = std::vector<std::reference_wrapper<const Landmark>>;

  /// The origin of the map frame is the centroid of the landmarks, at height 0.
  SemanticMap(TypeRegistry types, Crs crs, std::vector<Landmark> landmarks);
  SemanticMap(TypeRegistry types, Crs crs, std::vector<Landmark> landmarks, const Point<MapCrs>& origin);

  const TypeRegistry& types() const;
  const Crs& crs() const;
  const LocalFrame& frame() const;
  std::span<const Landmark> landmarks() const;
  std::size_t size() const { return landmarks().size(); }

  /// Returns the landmark of a uid; null if there is none.
  const Landmark* find(std::string_view uid) const;
  /// Returns the landmarks that pass the filter, in the order of the map.
  LandmarkRefs select(const LandmarkFilter& filter) const;
  /// Returns the landmarks in a box, in the order of the map.
  LandmarkRefs in_box(const MapBox& box, const LandmarkFilter& filter = {}) const;
  /// Returns the landmarks at most `radius` from `centre`, nearest first.
  LandmarkRefs near(const Point<MapCrs>& centre, Meters radius, const LandmarkFilter& filter = {}) const;
  LandmarkRefs near(const Point<MapFrame>& centre, Meters radius, const LandmarkFilter& filter = {}) const;
  /// Returns the `count` nearest landmarks that pass the filter, nearest first.
  LandmarkRefs nearest(const Point<MapCrs>& centre, std::size_t count,
                       const LandmarkFilter& filter = {}) const;

 private:
  struct Content;
  std::shared_ptr<const Content> content_;
};

}  // namespace waymark::inline landmarks
