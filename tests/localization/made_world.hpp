// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Cholesky>
#include <vector>

#include "core/random.hpp"
#include "localization/identification/landmark_grid.hpp"
#include "localization/motion_model.hpp"
#include "localization/sighting.hpp"
namespace waymark::test {
using namespace localization;

/// Draws landmarks over a square of `side` metres about the origin, with a known covariance.
inline std::vector<MapLandmark> scatter_landmarks(std::size_t count, double side, std::uint64_t seed,
                                                  double sd = 0.02) {
  Random random(seed, "landmarks");
  std::vector<MapLandmark> all(count);
  for (std::size_t i = 0; i < count; ++i) {
    all[i].key = i + 1;
    all[i].at = {random.uniform(-side / 2, side / 2), random.uniform(-side / 2, side / 2)};
    all[i].covariance = Eigen::Matrix2d::Identity() * sd * sd;
  }
  return all;
}

/// Noise of the odometry of made drives.
inline constexpr OdometryNoise kMadeNoise{.along_per_metre = 0.002,
                                          .across_per_metre = 0.0005,
                                          .yaw_per_metre = 0.0005,
                                          .yaw_per_radian = 0.002,
                                          .position_per_second = 1e-7,
                                          .yaw_per_second = 1e-7};

/// A robot on a circle that sees the landmarks within 12 m ahead. Errors, those of landmarks included, are
/// drawn from the distributions that the filters assume, so a correct filter is consistent.
class MadeDrive {
 public:
  MadeDrive(std::uint64_t seed, std::size_t landmarks = 60, bool named = true)
      : random_(seed, "drive"), named_(named), map_(scatter_landmarks(landmarks, 50, seed)), real_(map_) {
    for (MapLandmark& l : real_) l.at += 0.02 * Eigen::Vector2d(random_.normal(), random_.normal());
  }

  static constexpr double kRangeSd = 0.1, kBearingSd = 0.02;
  OdometryNoise noise = kMadeNoise;

  PoseEstimate start() {
    PoseEstimate e;
    e.covariance = Eigen::Vector3d(0.01, 0.01, 0.0004).asDiagonal();
    e.pose = pose_of(truth_.vector() + Eigen::Vector3d(0.1 * random_.normal(), 0.1 * random_.normal(),
                                                       0.02 * random_.normal()));
    return e;
  }

  /// Moves the robot; returns the odometry.
  BodyMotion drive(double seconds = 0.5) {
    const BodyMotion odometry = twist_motion(1, 0, 0.1, seconds, noise);
    const Eigen::Vector3d error = square_root(odometry.covariance) *
                                  Eigen::Vector3d(random_.normal(), random_.normal(), random_.normal());
    truth_ = truth_ * pose_of(odometry.step.vector() + error);
    return odometry;
  }

  SightingSet look() {
    SightingSet set;
    for (const MapLandmark& l : real_) {
      const Eigen::Vector2d to = l.at - truth_.at();
      const double range = to.norm(), bearing = wrap_angle(std::atan2(to.y(), to.x()) - truth_.yaw);
      if (range > 12 || range < 0.5 || std::abs(bearing) > 1.5) continue;
      SeenLandmark s;
      s.type = TypeId{0};
      s.range = range + kRangeSd * random_.normal();
      s.range_sd = kRangeSd;
      s.bearing = bearing + kBearingSd * random_.normal();
      s.bearing_sd = kBearingSd;
      if (named_) s.identity = l.key;
      if (*s.range > 0) set.sightings.push_back(s);
    }
    return set;
  }

  const Pose2& truth() const { return truth_; }
  const std::vector<MapLandmark>& map() const { return map_; }

 private:
  Random random_;
  bool named_;
  std::vector<MapLandmark> map_, real_;
  Pose2 truth_{-8, 0, -1.2};
};

/// e' P^-1 e.
inline double nees(const PoseEstimate& estimate, const Pose2& truth) {
  const Eigen::Vector3d e(estimate.pose.x - truth.x, estimate.pose.y - truth.y,
                          wrap_angle(estimate.pose.yaw - truth.yaw));
  return e.dot(estimate.covariance.ldlt().solve(e));
}

inline SeenLandmark seen_at(double range, double bearing) {
  SeenLandmark s;
  s.range = range;
  s.range_sd = 0.1;
  s.bearing = bearing;
  s.bearing_sd = 0.02;
  return s;
}

/// Returns the landmarks in a box, as a query of a map does.
inline std::vector<MapLandmark> landmarks_in(const Eigen::AlignedBox2d& box,
                                             const std::vector<MapLandmark>& all) {
  std::vector<MapLandmark> inside;
  for (const MapLandmark& l : all)
    if (box.contains(l.at)) inside.push_back(l);
  return inside;
}

inline MapLandmark landmark_at(double x, double y, LandmarkKey key) {
  MapLandmark l;
  l.key = key;
  l.at = {x, y};
  return l;
}

/// Returns the mean NEES, over 50 drives of 60 steps, of a filter that `make_filter` starts at the true pose.
/// Consistent is 1; 150 squares of unit normals lie within 0.79 and 1.24 with 95 %.
template <class MakeDrive, class MakeFilter>
double mean_nees(const MakeDrive& make_drive, const MakeFilter& make_filter) {
  constexpr int kRuns = 50;
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    auto drive = make_drive(seed);
    auto filter = make_filter(drive.truth());
    for (int i = 0; i < 60; ++i) {
      filter.predict(drive.drive());
      filter.update(drive.look());
    }
    sum += nees(filter.estimate(), drive.truth()) / (3 * kRuns);
  }
  return sum;
}

}  // namespace waymark::test
