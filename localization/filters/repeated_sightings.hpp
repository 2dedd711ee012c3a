// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/body_motion.hpp"
#include "localization/sighting.hpp"
namespace waymark {

/// How long, in seconds, the error a sensor makes with one landmark stays alike: its correlation falls to
/// 1/e. 0: each sighting errs anew.
struct ErrorMemory {
  double range = 0, bearing = 0;
};

/// Keeps filters from believing the same error many times. A camera that sees a bar code four times a second
/// errs four times in the same way, and a filter that takes the errors as independent becomes too sure of
/// itself. For an error with correlation rho from one sighting to the next (Gauss-Markov), a further sighting
/// says only (1 - rho) / (1 + rho) of what the first one said: its standard deviations are widened by that.
/// It holds for all localizers alike, since it changes what they are told.
///
/// Which sightings are of one landmark is judged by place alone, carried along by odometry, never by
/// identities. Bearings without range are not recognised and stay as they are.
class RepeatedSightings {
 public:
  explicit RepeatedSightings(const ErrorMemory& memory) : memory_(memory) {}

  void move(const BodyMotion& motion);
  /// Widens the standard deviations of what was seen before; `t` is the time of the set, s.
  void widen(SightingSet& seen, double t);

 private:
  struct Last {
    Eigen::Vector2d at;  // from the robot
    Eigen::Matrix2d covariance;
    std::optional<TypeId> type;
    double t = 0;
  };

  ErrorMemory memory_;
  std::vector<Last> last_;
};

}  // namespace waymark
