// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/body_motion.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Correlation times, s, of a sensor's errors with one landmark (fall to 1/e); 0: independent errors.
struct ErrorMemory {
  double range = 0, bearing = 0;
};

/// Widens the standard deviations of sightings whose errors repeat. A camera that sees a bar code four
/// times a second errs four times alike, and a filter that assumes independent errors becomes
/// overconfident. With correlation rho from one sighting to the next (Gauss-Markov), a further sighting
/// carries (1 - rho) / (1 + rho) of the information of the first. Acts on the measurements, so it serves
/// all localizers.
///
/// Sightings of one landmark are associated by position alone, predicted by odometry, never by identities.
/// Bearings without range are not associated and stay as they are.
class RepeatedSightings {
 public:
  explicit RepeatedSightings(const ErrorMemory& memory) : memory_(memory) {}

  void predict(const BodyMotion& motion);
  /// Widens the standard deviations of repeated sightings; `t` is the time of the set, s.
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

}  // namespace waymark::localization
