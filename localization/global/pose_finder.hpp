// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string_view>
#include <vector>
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Result of a global localization, in the map's frame.
struct PoseSearchResult {
  std::optional<PoseEstimate> accepted;  ///< the only pose that explains the sightings
  std::vector<PoseEstimate> candidates;  ///< best first, including the accepted one
  std::string_view reason = {};          ///< why none is accepted
};

/// Global localization: finds the pose of the robot from sightings and the map alone.
using PoseFinder = std::function<PoseSearchResult(const SightingSet&)>;

/// Returns whether a found pose differs from another by more than a metre and more than both covariances
/// explain.
bool are_distinct(const PoseEstimate& found, const PoseEstimate& other);

}  // namespace waymark::localization
