// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>
#include "core/units.hpp"
namespace waymark::inline landmarks {
struct SensorProfile;
}

namespace waymark::geodb {

/// Query of landmarks that meet every given condition. Coordinates are in the map's CRS; longitudes are equal
/// modulo 360 degrees.
struct MapQuery {
  /// Box, edges included. In a geographic CRS min_x > max_x crosses the antimeridian.
  struct Box {
    double min_x = 0, min_y = 0, max_x = 0, max_y = 0;
  };
  /// Circle about x, y; nearest landmarks first. Distances are horizontal: geodesic in a geographic CRS (also
  /// over poles and the antimeridian), planar otherwise.
  struct Near {
    double x = 0, y = 0;
    Meters radius;
  };
  /// The `k` nearest landmarks to x, y that meet the other conditions, nearest first; distance as for Near.
  /// Cannot be combined with Near or largest_first.
  struct NearestK {
    double x = 0, y = 0;
    std::int64_t k = 1;
  };
  /// Range of a number of the landmarks, limits included: a feature, `quality`, `confidence`, `seen` or any
  /// other column of numbers. Types without it give no landmarks; nor do landmarks where it is unknown.
  struct FeatureRange {
    std::string feature;
    double min_value = -std::numeric_limits<double>::infinity();
    double max_value = std::numeric_limits<double>::infinity();
  };

  std::vector<std::string> types = {};  ///< empty: all
  std::optional<Box> box = {};
  std::optional<Near> near = {};
  std::optional<NearestK> nearest = {};
  std::vector<FeatureRange> features = {};
  double min_quality = 0;                 ///< 0: also landmarks of unknown quality
  double min_confidence = 0;              ///< smallest probability of existence
  const SensorProfile* sensor = nullptr;  ///< weights the quality (eq. 8); null: equal weights
  /// Column of numbers to sort by, as for FeatureRange, largest first. Empty: by distance if the query has
  /// one, else by type and row.
  std::string largest_first = {};
  std::int64_t limit = std::numeric_limits<std::int64_t>::max();
};

}  // namespace waymark::geodb
