// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "localization/body_motion.hpp"
#include "localization/global/pose_finder.hpp"
namespace waymark::localization {

/// Returns whether a robot that was at `reckoned`, as odometry says, may be at `found`: odometry errs by up
/// to 0.3 m per metre driven beyond what the covariances state.
bool is_in_reach(const PoseEstimate& found, const PoseEstimate& reckoned, double driven);

/// Decides which poses of a finder a robot accepts that knows where it was.
/// - A pose within reach of dead reckoning is accepted at once.
/// - A pose that the robot cannot have reached by itself contradicts odometry: the robot was carried away, or
///   the place only looks alike. Such a claim is accepted when three answers of the finder agree that have no
///   sighting in common.
class PoseClaims {
 public:
  void predict(const BodyMotion& motion);
  /// Records that the pose is reliable: odometry errs from here on.
  void trust() { driven_ = 0, claim_.reset(); }

  enum class Verdict { accepted, open };
  /// Judges a pose found by the finder. `reckoned`: the last reliable pose, predicted by odometry. If the
  /// verdict is `open` the next answer must be of other sightings.
  Verdict judge(const PoseEstimate& found, const PoseEstimate& reckoned);

 private:
  double driven_ = 0;                  // m since the last reliable pose
  std::optional<PoseEstimate> claim_;  // a pose out of reach, predicted by odometry
  int answers_ = 0;                    // in a row that agree with it
};

}  // namespace waymark::localization
