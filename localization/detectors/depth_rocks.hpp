// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "localization/depth_image.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Options of the rock detector for depth images.
struct DepthRockOptions {
  std::optional<TypeId> type;  ///< of the sightings: first feature radius, second height (as `rock`)
  double cell = 0.15;          ///< m, cell size of the grid that points are binned into
  double min_height = 0.15;    ///< m above the surrounding ground
  double around = 1.5;         ///< m, radius of the ground fit
  double min_width = 0.2, max_width = 4;  ///< m
  double max_range = 15;                  ///< m
  int min_points = 6;
};

/// A rock detected in a depth image.
struct DepthRock {
  double range = 0, bearing = 0;  ///< of its centre, m and rad, on the horizontal plane
  double radius = 0, height = 0;  ///< m
  int points = 0;
  double range_sd = 0.1, bearing_sd = 0.01;
};

/// Detects rocks in a depth image. Points are levelled by the robot's roll and pitch and binned into cells.
/// The ground at each cell is a robust plane through the lowest points around it; cells above it are joined
/// to segments. 1 ms for 120 x 60 pixels.
std::vector<DepthRock> find_rocks(const DepthImage& image, const DepthRockOptions& options);

/// Detects rocks in a depth image and returns them as sightings.
SightingSet sightings_of_rocks(const DepthImage& image, const DepthRockOptions& options);

}  // namespace waymark::localization
