// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Result of a global localization, in the map's frame.
struct PoseSearchResult {
  std::optional<PoseEstimate> accepted;  ///< the only pose that explains the sightings
  std::vector<PoseEstimate> candidates;  ///< best first, including the accepted one
  std::string_view reason = {};          ///< why none is accepted
  /// That the first candidate is not the robot's pose; absent for ranges, whose poses are compared by chi2.
  std::optional<double> wrong_probability = {};
  /// ln of the expected number of chance poses as good as the best constellation; 0 without one.
  double log_false_alarms = 0;
};

/// Returns the probability that the first of distinct poses is wrong; 1 without poses.
/// - `log_false_alarms`: ln of the expected number of chance poses of the whole map that fit as well as each.
/// - The odds of a pose against a place outside the map are one over that number, for even odds before.
double wrong_probability(std::span<const double> log_false_alarms);

/// Global localization: finds the pose of the robot from sightings and the map alone.
using PoseFinder = std::function<PoseSearchResult(const SightingSet&)>;

/// Check of a pose: returns the pose near the expected one from which the sightings were made, if they fit it
/// better than chance allows anywhere in the map. Costs a thousandth of a search.
using PoseCheck =
    std::function<std::optional<PoseEstimate>(const SightingSet&, const PoseEstimate& expected)>;

/// Search next to where the robot should be. Chance is that of the poses which the prior allows, so fewer
/// sightings are proof than in the whole map.
using NearPoseFinder = std::function<PoseSearchResult(const SightingSet&, const PoseEstimate& prior)>;
/// Reason of a search that had nothing to compare with the map.
inline constexpr std::string_view kTooFewSightings = "too few sightings with range";

/// Returns the sets from one search of the whole map to the next, of a robot without a start, after `sets`
/// sets. At first each set shows much that is new; later a search costs more than it finds.
int search_interval(std::int64_t sets);

/// Returns the estimate of a robot that may be anywhere in a box, with any heading: centre, and the variances
/// of an even distribution plus 1 m^2. An empty box is one of unknown extent: 100 km of standard deviation.
PoseEstimate pose_anywhere(const Eigen::AlignedBox2d& box);

/// Returns whether a found pose differs from another by more than a metre and more than both covariances
/// explain.
bool are_distinct(const PoseEstimate& found, const PoseEstimate& other);

}  // namespace waymark::localization
