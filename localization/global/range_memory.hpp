// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <unordered_map>
#include <vector>
#include "localization/body_motion.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Recent ranges of a robot to identified landmarks, and its motion between them by odometry. Ranges from one
/// position leave a circle, ranges along a drive leave one pose (RangeResection).
/// - Holds at most 120 ranges of the last 100 m.
/// - Of each landmark at most one range per half metre driven: errors at one position are alike.
class RangeMemory {
 public:
  void predict(const BodyMotion& motion);
  void add(const SightingSet& seen);
  /// Returns the ranges, the oldest first.
  std::vector<EarlierRange> recall() const;

 private:
  struct Look {
    BodyMotion before;  // since the previous look
    double driven = 0;  // m, at this look
    Pose2 mount;
    std::vector<EarlierRange> ranges;
  };
  std::deque<Look> looks_;
  std::size_t count_ = 0;  // of ranges
  BodyMotion motion_;      // since the last look
  double driven_ = 0;
  std::unordered_map<LandmarkKey, double> measured_at_;  // metres driven at the last range of each landmark
};

}  // namespace waymark::localization
