// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>
#include "localization/identification/known_features.hpp"
#include "localization/identification/map_landmark.hpp"
#include "localization/slam/slam_line.hpp"
#include "localization/slam/slam_state.hpp"
namespace waymark::localization {

/// A landmark of the SLAM filter.
struct SlamLandmark {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  double log_odds = 0;  ///< of its existence: the evidence counter of section 4.4
  double missed = 0;    ///< the part of `log_odds` that views since the last match took (MissedViews)
  std::int64_t matches = 0;
  std::int64_t first_set = 0, last_set = 0;  ///< numbers of the sets that showed it first and last
  std::int64_t expected = 0;       ///< sets of sightings that should have shown it, matched ones included
  std::optional<LandmarkKey> key;  ///< of the map's landmark, or of the identity it was seen with
  bool gone = false;               ///< removed because the evidence says it does not exist
  bool was_mapped = false;         ///< it was in the initial map
  std::optional<TypeId> type;
  double quality = 1;        ///< of the map's landmark: probability that it exists
  double noise_divisor = 1;  ///< of the noise of its sightings (section 4.3); 1 unless `quality=paper`
  KnownFeatures features;    ///< the signature
  std::vector<KnownFeatures>
      feature_samples;                  ///< features of each match, for the map's statistics; at most 100
  std::size_t index = 0;                ///< constant while the filter lives
  std::optional<SlamLine> line;         ///< of a line; within the filter, `at` is then its two numbers
  std::optional<SlamState::Slot> slot;  ///< absent: known from the map and not seen yet
};

/// Makes a landmark of a map of a line: position instead of its two numbers, samples as azimuths.
void state_as_position(SlamLandmark& landmark);

}  // namespace waymark::localization
