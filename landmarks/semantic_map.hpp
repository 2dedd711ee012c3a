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
namespace waymark {

/// Which landmarks a query keeps.
struct LandmarkFilter {
  std::string type = {};                  ///< empty: all types
  double min_quality = 0;                 ///< 0 keeps landmarks of unknown quality too
  const SensorProfile* sensor = nullptr;  ///< whose quality (eq. 8); null: equal weights
};

/// Corners of a box in the map's CRS, inclusive. In degrees, west > east goes across the antimeridian.
struct MapBox {
  double west = 0, south = 0, east = 0, north = 0;
};

/// Landmarks in memory, immutable, to be asked from many threads; copies share everything.
/// Distances are horizontal, in metres: geodesics of the body's ellipsoid, so they hold across the
/// antimeridian and at the poles; plane distances in a local CRS.
class SemanticMap {
 public:
  /// For `for (const Landmark& rock : map.near(...))`. Valid as long as a copy of the map lives.
  using Found = std::vector<std::reference_wrapper<const Landmark>>;

  /// The map frame's origin is the middle of the landmarks, at the ellipsoid's surface.
  SemanticMap(TypeRegistry types, Crs crs, std::vector<Landmark> landmarks);
  SemanticMap(TypeRegistry types, Crs crs, std::vector<Landmark> landmarks, const Point<MapCrs>& origin);

  const TypeRegistry& types() const;
  const Crs& crs() const;
  const LocalFrame& frame() const;
  std::span<const Landmark> landmarks() const;
  std::size_t size() const { return landmarks().size(); }

  const Landmark* find(std::string_view uid) const;
  /// All that pass the filter, in the map's order.
  Found where(const LandmarkFilter& filter) const;
  /// In the map's order.
  Found in_box(const MapBox& box, const LandmarkFilter& filter = {}) const;
  /// Nearest first.
  Found near(const Point<MapCrs>& centre, Meters radius, const LandmarkFilter& filter = {}) const;
  Found near(const Point<MapFrame>& centre, Meters radius, const LandmarkFilter& filter = {}) const;
  /// The `count` nearest that pass the filter, nearest first.
  Found nearest(const Point<MapCrs>& centre, std::size_t count, const LandmarkFilter& filter = {}) const;

 private:
  struct Content;
  std::shared_ptr<const Content> content_;
};

}  // namespace waymark
