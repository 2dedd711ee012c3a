// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>
#include "core/units.hpp"
namespace waymark {

struct SensorProfile;

/// Which landmarks of a map are wanted: those that meet every condition given. Coordinates are in the map's
/// CRS; longitudes count modulo 360, whatever range the map uses.
struct MapQuery {
  /// Edges included. On a geographic CRS min_x > max_x means a box across the antimeridian.
  struct Box {
    double min_x = 0, min_y = 0, max_x = 0, max_y = 0;
  };
  /// Within `radius` metres of x, y, measured on the ground: a geodesic on the body of a geographic CRS (also
  /// over a pole or the antimeridian), a plane otherwise. Heights do not count. Nearest first.
  struct Near {
    double x = 0, y = 0;
    Meters radius;
  };
  /// The `k` nearest to x, y that meet the other conditions, nearest first; distance as for Near. Not
  /// together with Near or largest_first.
  struct NearestK {
    double x = 0, y = 0;
    std::int64_t k = 1;
  };
  /// Feature known and within [lowest, highest]. Types that have no such feature give nothing.
  struct FeatureRange {
    std::string feature;
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
  };

  std::vector<std::string> types = {};  ///< empty: all
  std::optional<Box> box = {};
  std::optional<Near> near = {};
  std::optional<NearestK> nearest = {};
  std::vector<FeatureRange> features = {};
  double min_quality = 0;  ///< 0: also landmarks whose quality is unknown
  const SensorProfile* sensor =
      nullptr;  ///< quality weighted for it (eq. 8); null: all features weigh the same
  /// Feature, or "quality", whose largest values come first; empty: by distance where one is asked for, else
  /// by type and place on the Hilbert curve.
  std::string largest_first = {};
  std::int64_t limit = std::numeric_limits<std::int64_t>::max();
};

}  // namespace waymark
