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
#include "geo/crs.hpp"
#include "geo/local_frame.hpp"
#include "landmarks/landmark_type.hpp"
#include "landmarks/sensor_profile.hpp"
namespace waymark::inline landmarks {

/// Returns the uid of a landmark, e.g. "mt-3kq8zt0v5d1xj". It is stable over runs, tiles and threads.
/// - It consists of the initials of the type and a 64-bit hash of type, CRS id and position in Crockford's
///   base 32 (without i, l, o, u).
/// - Positions are rounded to 1e-7 degrees or 1 cm; longitudes are equal modulo 360 degrees.
/// - Two of 1e6 landmarks share a uid with probability 3e-8.
std::string make_uid(const LandmarkType& type, const Crs& crs, const Point<MapCrs>& position);

/// Assigns uids to all landmarks. Duplicates get the suffixes "-2", "-3", ... in the given order: sort first.
void assign_uids(const TypeRegistry& types, const Crs& crs, std::span<Landmark> landmarks);

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
