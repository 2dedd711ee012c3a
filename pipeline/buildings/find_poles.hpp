// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>
#include "geo/canopy_source.hpp"
namespace waymark::pipeline {

/// Limits of poles in airborne laser points. Metres.
struct PoleRules {
  double min_height = 2.5;  ///< of the highest return above the ground
  double max_height = 40;
  double max_width = 0.8;  ///< of the returns above 1 m, across
  double clearance = 1;    ///< to the nearest other return above 1 m
  std::int64_t min_returns = 4;
  friend bool operator==(const PoleRules&, const PoleRules&) = default;
};

/// Pole detected from above. Metres in the axes of the survey, as DetectedBuilding.
struct DetectedPole {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double sd = 0;      ///< of the position along each axis
  double height = 0;  ///< ground to the highest return
  double ground = 0;  ///< elevation of its foot; NaN if unknown
  std::int64_t returns = 0;
  double confidence = 1;
};

struct FoundPoles {
  std::vector<DetectedPole> poles;               ///< by position
  std::map<std::string, std::int64_t> rejected;  ///< reason -> groups of returns
};

/// Detects poles: groups of returns, one above the other, with clear ground around.
/// - Returns above 1 m that lie within `clearance` of each other are a group.
/// - A group is a pole if it is narrow, high enough, and returns lie in three different heights at least.
/// - Only groups whose centre lies in `owned`, cells of the survey, are returned and counted.
/// The order of the returns does not matter. About 1 us per return.
FoundPoles find_poles(const CanopySource& canopy, const Window& owned, const PoleRules& rules);

}  // namespace waymark::pipeline
