// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <optional>
#include <utility>
#include "localization/global/pose_finder.hpp"
#include "localization/global/range_memory.hpp"
#include "localization/identification/feature_distance.hpp"
#include "localization/sighting.hpp"
#include "localization/slam/slam_state.hpp"
namespace waymark::localization {

/// Recent sightings of a robot as one set, and the robot's position among them.
struct RememberedSightings {
  SightingSet set;  ///< in the frame of the robot; covariances are about the best common fit, not the robot
  Eigen::Matrix3d robot_covariance = Eigen::Matrix3d::Zero();  ///< of the robot's pose in that frame
};

/// Recent sightings of a robot. They are a submap: SLAM without a map over the last sets (Bosse et al. 2003),
/// so that overlapping sets correct the odometry between them.
/// - Each object is one sighting, however often it was seen: repeated sightings of it are no new evidence.
/// - Errors are those of the shape of the submap (free network, Baarda 1973): position and heading of the
///   submap as a whole have none. The error of the robot in it is given apart.
/// - An object that should have been seen in ten sets, and was not, is forgotten.
/// - The submap is made when it is recalled. Until then sets are only stored, at most the last 100.
class SightingMemory {
 public:
  /// `scales` name the features that turn with the robot, which are not remembered.
  explicit SightingMemory(FeatureScales scales = {}) : scales_(std::move(scales)) {}

  void predict(const BodyMotion& motion) {
    motion_ = compose(motion_, motion);
    ranges_.predict(motion);
  }
  void add(const SightingSet& seen);
  /// Returns at most `max_count` objects, those seen repeatedly first, then the nearest.
  RememberedSightings recall(std::size_t max_count = 40);
  /// Calls the finder on what is remembered, the bearings of the present set and recent ranges without
  /// bearing. Adds the error of the robot in the submap to the poses found; ranges are relative to the robot
  /// itself.
  PoseSearchResult find(const PoseFinder& finder, const SightingSet& seen);
  PoseSearchResult find_near(const NearPoseFinder& finder, const SightingSet& seen,
                             const PoseEstimate& prior);
  /// Calls the check in the same way.
  std::optional<PoseEstimate> check(const PoseCheck& check, const SightingSet& seen,
                                    const PoseEstimate& expected);

 private:
  struct Object {
    SeenLandmark seen;
    Eigen::Matrix2d noise = Eigen::Matrix2d::Zero();  // of its most precise sighting, in the submap's frame
    int times = 1, missed = 0;                        // missed: sets since it was seen
  };
  struct Candidate {
    std::size_t sighting;
    SlamState::Slot slot;
    double squares;
  };
  void integrate(const BodyMotion& motion, const SightingSet& seen);
  std::vector<Candidate> candidates(const SightingSet& seen, std::vector<bool>& is_new) const;
  void insert(const SeenLandmark& seen, const Pose2& mount);
  void forget(const SightingSet& seen);
  void catch_up();
  std::vector<SlamState::Slot> nearest_objects(const SlamState& state, std::size_t max_count) const;

  FeatureScales scales_;
  RangeMemory ranges_;
  BodyMotion motion_;                                      // since the last set
  std::deque<std::pair<BodyMotion, SightingSet>> stored_;  // not yet in the submap, with the motion before
  std::optional<SlamState> state_;                         // the submap, in the frame of its first set
  std::vector<Object> objects_;                            // by slot
  double reach_ = 0, view_ = 0;                            // largest range and bearing of a sighting
};

/// Adds to remembered sightings those of the current set without range, which are not remembered.
SightingSet add_bearings(SightingSet remembered, const SightingSet& seen);

}  // namespace waymark::localization
