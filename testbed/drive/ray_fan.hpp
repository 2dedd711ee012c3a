// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>
#include "testbed/drive/laser_targets.hpp"
namespace waymark::testbed {

struct FanHit {
  double range = 0;  ///< metres
  TargetKind kind = TargetKind::ground;
  std::uint32_t index = 0;  ///< of the rock, stem or thicket
};

/// Casts rays from one point. Targets are sorted by azimuth and distance, so that a ray tests only those in
/// its direction. Same result as testing every target.
class RayFan {
 public:
  /// `reach`: maximum range, metres; `t`: time, s; trees felled by then are absent.
  RayFan(const LaserTargets& targets, const Eigen::Vector3d& origin, double reach, double t = 0);

  /// Returns the first hit of a ray; `std::nullopt` if nothing lies within reach. `along` is a unit vector.
  /// `random` draws where a beam ends in a thicket; without it thickets are transparent.
  std::optional<FanHit> cast(const Eigen::Vector3d& along, Random* random = nullptr) const;

  /// Casts as cast() does, without sorting; the reference in tests.
  std::optional<FanHit> cast_exhaustively(const Eigen::Vector3d& along, Random* random = nullptr) const;

  const Eigen::Vector3d& origin() const { return origin_; }

 private:
  struct Candidate {
    double near;  // horizontal distance of its nearest point
    TargetKind kind;
    std::uint32_t index;
  };
  std::optional<double> intersect_target(const Candidate& c, const Eigen::Vector3d& along,
                                         Random* random) const;
  std::optional<FanHit> first(std::span<const std::uint32_t> order, const Eigen::Vector3d& along,
                              Random* random, bool sorted) const;

  const LaserTargets& targets_;
  Eigen::Vector3d origin_;
  double reach_;
  std::vector<Candidate> candidates_;          // nearest first
  std::vector<std::uint32_t> first_, listed_;  // per sector, candidates, nearest first
};

}  // namespace waymark::testbed
