// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <span>
#include <vector>
#include "localization/identification/doubt_calibration.hpp"
#include "localization/identification/identification.hpp"
#include "localization/identification/landmark_window.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Estimates the density of sightings that show no landmark of the map: false detections, and objects that
/// the map lacks. It is the mean number of sightings per set over the sensor's view, times the fraction that
/// is not of the map. The view is the rectangle in range and bearing on which a uniform density has the
/// same second moments. Forgets within some 50 sets.
///
/// A landmark of the map competes with this density by its rate of detection. Where the terrain hides nine of
/// ten landmarks, one that fits by chance is as much too easy to find as this rate is small.
class ClutterEstimate {
 public:
  /// Adds the sightings of a set, before they are matched.
  void add_sightings(const SightingSet& seen);
  /// Adds a set's expected number of sightings that are not of the map, of `count` matched ones.
  void add_unmapped(double unmapped, double count);
  /// Returns the density per metre of range and radian of bearing. Half of the sightings count as unmapped
  /// until matches are known. Bearings without range are taken as spread over `bearing_reach` metres, ranges
  /// without bearing over a full turn.
  double density(double bearing_reach) const;
  /// Adds the number of landmarks of the map in view of the set whose matches were added last.
  void add_in_view(double landmarks) { in_view_ = kKept * in_view_ + landmarks; }
  /// Returns the fraction of the landmarks in view that is seen; 1 until any was in view.
  double detection() const;
  /// Returns the range, m, and the bearing to each side, rad, of the view; 0 until any range is known.
  double view_range() const;
  double view_bearing() const;

 private:
  static constexpr double kKept = 1 - 1.0 / 50;                                 // of the past, per set
  double sets_ = 0, sightings_ = 0;                                             // discounted numbers
  double ranged_ = 0, squared_range_ = 0, directed_ = 0, squared_bearing_ = 0;  // sums
  double unmapped_ = 0, matched_ = 0, in_view_ = 0;
};

/// Matches sightings with the landmarks around a robot. Bundles the map, the scales of its features and the
/// options of data association, which every filter needs. Copies are independent but for what was learnt of
/// doubtful landmarks: that is of the map, and a filter that restarts keeps it.
class LandmarkMatcher {
 public:
  explicit LandmarkMatcher(LandmarkWindow map, FeatureScales scales = {}, IdentificationOptions options = {})
      : map_(std::move(map)),
        scales_(std::move(scales)),
        options_(std::move(options)),
        min_clutter_(options_.clutter) {}

  /// Returns at least the landmarks that the sightings may show from a pose, and those in view of the sensor
  /// or within `view_range` metres. Valid until the next call.
  const LandmarkGrid& landmarks_near(const SightingSet& seen, const PoseEstimate& robot,
                                     double view_range = 0);
  /// Returns at least the landmarks within `reach` metres of a position. Valid until the next call.
  const LandmarkGrid& landmarks_near(const Eigen::Vector2d& at, double reach) {
    return map_.landmarks_near(at, reach);
  }

  /// Prepares for a set: estimates the density of sightings without landmark (`learn_clutter`).
  void observe(const SightingSet& seen);
  /// Learns from the matches of the set, made at a pose, the fraction of sightings that are not of the map.
  /// Learns also what part of the landmarks in view is seen, and how many of the doubtful ones exist. `map`:
  /// from landmarks_near. Does nothing if they are not the matches of the set.
  void learn(std::span<const Match> matches, const SightingSet& seen, const PoseEstimate& robot,
             const LandmarkGrid& map);

  /// Matches the sightings of a set; see waymark::identify. `map`: from landmarks_near.
  Identification identify(const SightingSet& seen, const PoseEstimate& robot, const LandmarkGrid& map) const {
    return waymark::localization::identify(seen, robot, map, scales_, options_);
  }
  /// Returns the candidates of one sighting; see waymark::candidates. `map`: from landmarks_near.
  Candidates candidates(const SeenLandmark& seen, const Pose2& robot_from_sensor, const PoseEstimate& robot,
                        const LandmarkGrid& map) const {
    return waymark::localization::candidates(seen, robot_from_sensor, robot, map, scales_, options_);
  }

  /// Makes learn() leave doubtful landmarks to the copies of this matcher, so that a set counts once.
  void leave_doubt_to_copies() { learns_doubt_ = false; }

  const FeatureScales& scales() const { return scales_; }
  /// Returns the options; `clutter` is the estimated density over the rate of detection, `doubt_factors` what
  /// was learnt of doubtful landmarks.
  const IdentificationOptions& options() const { return options_; }

 private:
  void set_clutter();
  void learn_doubt(std::span<const Match> matches, const SightingSet& seen, const PoseEstimate& robot,
                   const LandmarkGrid& map);
  double landmarks_in_view(const SightingSet& seen, const Pose2& robot, const LandmarkGrid& map);

  LandmarkWindow map_;
  FeatureScales scales_;
  IdentificationOptions options_;
  ClutterEstimate clutter_;
  std::shared_ptr<DoubtCalibration> doubt_ = std::make_shared<DoubtCalibration>();
  bool learns_doubt_ = true;
  double min_clutter_;
  std::vector<TypeId> seen_types_;  // of any sighting so far
  bool any_type_ = false;           // a sighting had no type, so it may be of any
};

}  // namespace waymark::localization
