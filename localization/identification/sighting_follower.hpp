// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "localization/body_motion.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Follows objects from one set of sightings to the next by odometry alone, whether or not the map has them.
/// An object seen again is no new evidence of what it is: a filter that takes it for such grows sure of its
/// first decision, right or wrong.
class SightingFollower {
 public:
  /// A sighting of an object that was seen before.
  struct Seen {
    int object = 0;      ///< number of the object
    double metres = -1;  ///< driven since its last sighting; negative: it was not seen before
  };
  void predict(const BodyMotion& motion);
  /// Returns for each sighting the object that it shows. Sightings without a range, of another type, or with
  /// no object within three standard deviations show a new one. Objects not seen for five metres are
  /// forgotten.
  std::vector<Seen> follow(const SightingSet& seen);

 private:
  struct Object {
    int number = 0;
    Eigen::Vector2d at;  // in the frame of odometry
    SeenLandmark seen;   // at first
    double driven = 0;   // at its last sighting
  };
  Pose2 odometry_;
  double driven_ = 0;
  int count_ = 0;
  std::vector<Object> objects_;
};

}  // namespace waymark::localization
