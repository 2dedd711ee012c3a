// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>
#include "core/options.hpp"
#include "localization/localizer.hpp"
namespace waymark {

struct SlamOptions {
  double match = 9.21;     ///< squared Mahalanobis distance up to which a sighting is a landmark
  double fresh = 25;       ///< and beyond which it is a new one; between the two it is ambiguous and not used
  double nearest = 2;      ///< m: no new landmark closer than this to another
  double most_range = 40;  ///< m; sightings farther away are not used
  double seen = 0.85;      ///< log odds a match adds to a landmark's existence
  double unseen = -0.5;    ///< log odds that being expected and not seen adds
  double confirmed = 2;    ///< log odds from which a landmark moves the robot
  double dropped = -1;     ///< log odds below which it is forgotten
  double field_of_view = 1.4;  ///< rad to each side where sightings are expected

  void describe(OptionVisitor& option);
};

/// A landmark that SLAM holds.
struct SlamLandmark {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double log_odds = 0;  ///< that it exists: the evidence counter of section 4.4
  std::int64_t matches = 0;
};

/// Robot and landmarks in one Gaussian (section 4.4; Smith, Self & Cheeseman 1990), for sightings that do not
/// say who they are: one-to-one greedy pairing, a band of ambiguity against duplicates, existence by
/// evidence. The covariance is kept whole: each matched sighting costs O(landmarks^2).
class EkfSlam final : public Localizer {
 public:
  explicit EkfSlam(const PoseEstimate& start, SlamOptions options = {});
  void move(const BodyMotion& motion) override;
  std::vector<Match> see(const SightingSet& seen) override;
  PoseEstimate estimate() const override;
  const std::vector<SlamLandmark>& landmarks() const { return landmarks_; }

 private:
  struct Pair {
    double squares;
    std::size_t sighting, landmark;
  };
  Eigen::Index row(std::size_t landmark) const { return 3 + 2 * static_cast<Eigen::Index>(landmark); }
  void settle();
  void update(const SeenLandmark& seen, const Pose2& mount, std::size_t landmark);
  void add(const SeenLandmark& seen, const Pose2& mount);
  void forget();

  SlamOptions options_;
  Pose2 pose_;
  BodyMotion pending_;  ///< driven since the last sightings
  std::vector<SlamLandmark> landmarks_;
  Eigen::MatrixXd covariance_;  ///< robot, then landmarks; room for more than there are
};

}  // namespace waymark
