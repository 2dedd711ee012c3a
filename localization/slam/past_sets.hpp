// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <functional>
#include <vector>
#include "localization/body_motion.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Sets of sightings of the last 30 m of a drive with SLAM's pose at each, one per half metre or half radian.
/// They judge a pose that contradicts SLAM.
/// - Rooms look alike, so sightings in a room that the map lacks may fit another room. The robot came from
///   somewhere: a pose that odometry cannot reach must also explain the sightings on the way.
/// - A robot that was carried away has no such past. It suddenly sees none of the landmarks around it, and
///   the past is forgotten.
class PastSets {
 public:
  /// Returns for each sighting whether a landmark of the map may explain it from a pose.
  using Explain = std::function<std::vector<bool>(const SightingSet&, const PoseEstimate&)>;

  void predict(const BodyMotion& motion) { driven_ += motion.step.at().norm(); }
  /// Adds a set and SLAM's pose. `found`: landmarks that it shows, of those `expected` because SLAM knows
  /// them and saw them shortly before.
  void add(const SightingSet& seen, const PoseEstimate& robot, int found, int expected);
  /// Moves the past with the robot, which restarts at another pose.
  void move(const Pose2& from, const Pose2& to);
  /// Returns whether the past contradicts a pose, where SLAM has `robot`. Compares the sightings that are
  /// explained at one of the two only, from sets where odometry does not explain the difference. In some
  /// beginning of the past they favour SLAM as much as by chance in one of 10,000 cases. At most 200 calls of
  /// `explain`.
  bool contradict(const PoseEstimate& rival, const PoseEstimate& robot, const Explain& explain) const;
  std::size_t size() const { return sets_.size(); }

 private:
  struct Past {
    SightingSet seen;
    PoseEstimate robot;
    double driven;  // m, until then
  };
  std::deque<Past> sets_;
  double driven_ = 0;                // m
  double found_ = 0, expected_ = 0;  // landmarks, over some three sets
};

}  // namespace waymark::localization
