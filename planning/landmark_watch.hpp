// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <unordered_map>
#include <vector>
#include "localization/identification/identification.hpp"
#include "planning/information_field.hpp"
namespace waymark::planning {

/// Notices landmarks of the map that are not there: those that a well-localized vehicle should see and does
/// not. Existence is a log-odds filter (Thrun et al. 2005, section 4.2) over sets of sightings.
class LandmarkWatch {
 public:
  LandmarkWatch(localization::LandmarkGrid map, LandmarkSensing sensing);

  /// Takes the matches of a set of sightings, made at a pose. Poses with an sd of the position over a metre
  /// are not used. Landmarks in the outer third of the range and at the edge of the view are not used,
  /// either.
  void add(const localization::PoseEstimate& robot, std::span<const localization::Match> matches);

  /// Returns the landmarks that exist with a probability below 0.1, by key, ascending.
  std::vector<localization::LandmarkKey> gone() const;

 private:
  localization::LandmarkGrid map_;
  LandmarkSensing sensing_;
  std::unordered_map<localization::LandmarkKey, double> log_odds_;
};

/// Returns the map without these landmarks; `keys` ascending.
localization::LandmarkGrid map_without(const localization::LandmarkGrid& map,
                                       std::span<const localization::LandmarkKey> keys);

}  // namespace waymark::planning
