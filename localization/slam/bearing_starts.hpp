// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "localization/body_motion.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Keeps bearings without a range until they start a landmark (delayed initialization; Bailey 2003): the
/// first and the last bearing of an object are intersected once they differ enough.
/// - Bearings of one identity are of one object. Without identities each must be the only one of its type
///   that the other may be after the motion between them. Ambiguous bearings are not used.
/// - An object starts a landmark after three bearings or more, if those between agree with the position and
///   its distance is known to a fifth.
class BearingStarts {
 public:
  /// `max_range`: largest distance of a landmark, m.
  explicit BearingStarts(double max_range = 40) : max_range_(max_range) {}

  /// A landmark in the robot's frame of now.
  struct Start {
    std::size_t sighting;
    Eigen::Vector2d at;
    Eigen::Matrix2d covariance;  ///< m^2; of bearings and of the odometry between them
  };
  void predict(const BodyMotion& motion);
  /// Takes the bearings of a set that match no landmark, and returns the landmarks that they start. Their
  /// bearings are forgotten.
  std::vector<Start> add(const SightingSet& seen, const std::vector<std::size_t>& unmatched,
                         bool use_identities);
  std::size_t objects() const { return objects_.size(); }

 private:
  struct Look {
    BodyMotion since;  // motion of the robot from then to now
    Pose2 mount;
    double bearing, sd;
  };
  struct Object {
    std::optional<std::uint64_t> identity;
    std::optional<TypeId> type;
    std::vector<Look> looks;
  };
  bool may_be(const Object& object, const Look& now) const;
  std::optional<Start> start(const Object& object) const;

  double max_range_;
  std::vector<Object> objects_;
};

}  // namespace waymark::localization
