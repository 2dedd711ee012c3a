// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "testbed/drive/laser_targets.hpp"
namespace waymark {

struct FanHit {
  double range = 0;  ///< metres
  TargetKind kind = TargetKind::ground;
  std::uint32_t index = 0;  ///< of the rock, stem or thicket
};

/// Rays from one point: what stands near it, sorted by azimuth and distance, so that a ray asks only what
/// lies in its direction. Meets the same as asking every target.
class RayFan {
 public:
  /// Sees `reach` metres far; `t` s: what is felled by then is gone.
  RayFan(const LaserTargets& targets, const Eigen::Vector3d& origin, double reach, double t = 0);

  /// The first thing a ray meets; nothing within reach: none. `along` is a unit vector. `random` decides
  /// where a beam ends in a thicket; without it thickets let everything through.
  std::optional<FanHit> cast(const Eigen::Vector3d& along, Random* random = nullptr) const;

  /// The same without the sorting: its twin in tests.
  std::optional<FanHit> cast_slowly(const Eigen::Vector3d& along, Random* random = nullptr) const;

  const Eigen::Vector3d& origin() const { return origin_; }

 private:
  struct Candidate {
    double near;  // horizontal distance of its nearest point
    TargetKind kind;
    std::uint32_t index;
  };
  std::optional<double> meet_one(const Candidate& c, const Eigen::Vector3d& along, Random* random) const;
  template <class Candidates>
  std::optional<FanHit> first(const Candidates& order, const Eigen::Vector3d& along, Random* random,
                              bool sorted) const;

  const LaserTargets& targets_;
  Eigen::Vector3d origin_;
  double reach_;
  std::vector<Candidate> candidates_;          // nearest first
  std::vector<std::uint32_t> first_, listed_;  // per sector, candidates, nearest first
};

}  // namespace waymark
