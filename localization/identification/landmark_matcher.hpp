// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include "localization/identification/clutter_estimate.hpp"
#include "localization/identification/identification.hpp"
#include "localization/identification/landmark_window.hpp"
namespace waymark::localization {

/// Matches sightings with the landmarks around a robot. Bundles the map, the scales of its features and the
/// options of data association, which every filter needs. Copies are independent.
class LandmarkMatcher {
 public:
  explicit LandmarkMatcher(LandmarkWindow map, FeatureScales scales = {}, IdentificationOptions options = {})
      : map_(std::move(map)),
        scales_(std::move(scales)),
        options_(std::move(options)),
        min_clutter_(options_.clutter) {}

  /// Returns at least the landmarks that the sightings may show from a pose, and those within `view_range`
  /// metres. Valid until the next call.
  const LandmarkGrid& landmarks_near(const SightingSet& seen, const PoseEstimate& robot,
                                     double view_range = 0);
  /// Returns at least the landmarks within `reach` metres of a position. Valid until the next call.
  const LandmarkGrid& landmarks_near(const Eigen::Vector2d& at, double reach) {
    return map_.landmarks_near(at, reach);
  }

  /// Prepares for a set: estimates the density of sightings without landmark (`learn_clutter`).
  void observe(const SightingSet& seen);
  /// Learns from the matches of the set how many of its sightings are not of the map.
  void learn(std::span<const Match> matches);

  /// Matches the sightings of a set; see waymark::identify. `map`: from landmarks_near.
  Identification identify(const SightingSet& seen, const PoseEstimate& robot, const LandmarkGrid& map) const {
    return waymark::localization::identify(seen, robot, map, scales_, options_);
  }
  /// Returns the candidates of one sighting; see waymark::candidates. `map`: from landmarks_near.
  Candidates candidates(const SeenLandmark& seen, const Pose2& robot_from_sensor, const PoseEstimate& robot,
                        const LandmarkGrid& map) const {
    return waymark::localization::candidates(seen, robot_from_sensor, robot, map, scales_, options_);
  }

  const FeatureScales& scales() const { return scales_; }
  /// Returns the options; `clutter` is the estimated density.
  const IdentificationOptions& options() const { return options_; }

 private:
  void set_clutter();

  LandmarkWindow map_;
  FeatureScales scales_;
  IdentificationOptions options_;
  ClutterEstimate clutter_;
  double min_clutter_;
};

}  // namespace waymark::localization
