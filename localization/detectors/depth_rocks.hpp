// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "localization/depth_image.hpp"
#include "localization/sighting.hpp"
namespace waymark {

/// What stands above the ground in a depth image and is taken for a rock.
struct DepthRocks {
  std::optional<TypeId> type;  ///< given to the sightings: first feature radius, second height (as `rock`)
  double cell = 0.15;          ///< m, of the squares that points fall into
  double least_height = 0.15;  ///< m above the ground around
  double around = 1.5;         ///< m within which the ground is looked for
  double least_width = 0.2, most_width = 4;  ///< m
  double most_range = 15;                    ///< m
  int least_points = 6;
};

struct DepthRock {
  double range = 0, bearing = 0;  ///< of its middle, m and rad, on the level plane
  double radius = 0, height = 0;  ///< m
  int points = 0;
  double range_sd = 0.1, bearing_sd = 0.01;
};

/// Points are levelled by the robot's roll and pitch and sorted into squares. The ground at each is a plane
/// through the lowest points around it without what stands out; squares that stand above it are joined to
/// segments. 1 ms for 120 x 60 pixels.
std::vector<DepthRock> find_rocks(const DepthImage& image, const DepthRocks& options);

SightingSet sightings_of_rocks(const DepthImage& image, const DepthRocks& options);

}  // namespace waymark
