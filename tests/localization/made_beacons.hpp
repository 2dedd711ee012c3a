// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "localization/motion_model.hpp"
#include "tests/localization/made_world.hpp"
namespace waymark::test {
using namespace localization;

/// What a made drive among beacons is like.
struct BeaconSettings {
  std::size_t beacons = 4;
  Pose2 mount{};
  double outliers = 0;  ///< fraction of ranges that are 1 to 5 m too long
  bool straight = false;
  bool named = true;
  double map_sd = 0.01;   ///< m
  double start_sd = 0.3;  ///< m
  double offset_sd = 0;   ///< m, of the offset of each beacon's ranges
  double max_height = 0;  ///< m above the antenna; heights are even from a third of it
};

/// A robot on a loop of about 100 m inside four beacons that measures only ranges to them. Errors are drawn
/// from the distributions that the filters assume.
class BeaconDrive {
 public:
  static constexpr double kRangeSd = 0.2;
  OdometryNoise noise{.along_per_metre = 0.001,
                      .across_per_metre = 1e-4,
                      .yaw_per_metre = 2e-4,
                      .yaw_per_radian = 0.002,
                      .position_per_second = 1e-8,
                      .yaw_per_second = 1e-8};

  explicit BeaconDrive(std::uint64_t seed, const BeaconSettings& settings = {})
      : random_(seed, "beacons"), settings_(settings) {
    constexpr double kCorners[4][2] = {{-22, -18}, {22, -14}, {18, 20}, {-19, 16}};
    for (std::size_t i = 0; i < settings.beacons; ++i) {
      map_.push_back(landmark_at(kCorners[i][0] + random_.uniform(-5, 5),
                                 kCorners[i][1] + random_.uniform(-5, 5), i + 1));
      map_.back().covariance = Eigen::Matrix2d::Identity() * settings.map_sd * settings.map_sd;
      real_.push_back(map_.back().at + settings.map_sd * Eigen::Vector2d(random_.normal(), random_.normal()));
    }
    for (std::size_t i = 0; i < settings.beacons; ++i) {
      offsets_.push_back(settings.offset_sd > 0 ? settings.offset_sd * random_.normal() : 0);
      heights_.push_back(settings.max_height > 0 ? settings.max_height * random_.uniform(1.0 / 3, 1) : 0);
    }
    turn_ = settings.straight ? 0 : (random_.bernoulli(0.5) ? 1 : -1) / 16.0;
    truth_ = settings.straight
                 ? Pose2{random_.uniform(-12, -8), random_.uniform(-8, 8), random_.uniform(-0.3, 0.3)}
                 : Pose2{random_.uniform(-2, 2), turn_ > 0 ? -15.0 : 15.0, random_.uniform(-0.2, 0.2)};
  }

  PoseEstimate start() {
    const double sd = settings_.start_sd;
    const Eigen::Vector3d off(sd * random_.normal(), sd * random_.normal(), 0.05 * random_.normal());
    return {pose_of(truth_.vector() + off), Eigen::Vector3d(sd * sd, sd * sd, 0.0025).asDiagonal()};
  }

  /// Drives 0.5 m; returns the odometry.
  BodyMotion drive() {
    const double turn = settings_.straight ? 0 : turn_ * (1 + 0.5 * std::sin(0.11 * ++steps_));
    const BodyMotion odometry = twist_motion(1, 0, turn, 0.5, noise);
    const Eigen::Vector3d error = square_root(odometry.covariance) *
                                  Eigen::Vector3d(random_.normal(), random_.normal(), random_.normal());
    truth_ = truth_ * pose_of(odometry.step.vector() + error);
    return odometry;
  }

  /// Measures each beacon with probability 1/2.
  SightingSet look() {
    SightingSet set{settings_.mount, {}};
    const Eigen::Vector2d sensor = (truth_ * settings_.mount).at();
    for (std::size_t i = 0; i < real_.size(); ++i) {
      if (random_.bernoulli(0.5)) continue;
      SeenLandmark s;
      s.range =
          std::hypot((real_[i] - sensor).norm(), heights_[i]) + offsets_[i] + kRangeSd * random_.normal();
      s.range_sd = kRangeSd;
      if (random_.bernoulli(settings_.outliers)) *s.range += random_.uniform(1, 5);
      if (settings_.named) s.identity = map_[i].key;
      if (*s.range > 0) set.sightings.push_back(s);
    }
    return set;
  }

  const Pose2& truth() const { return truth_; }
  const std::vector<MapLandmark>& map() const { return map_; }
  const std::vector<Eigen::Vector2d>& real() const { return real_; }  ///< positions of the beacons
  const std::vector<double>& offsets() const { return offsets_; }     ///< m, of their ranges
  const std::vector<double>& heights() const { return heights_; }     ///< m above the antenna

 private:
  Random random_;
  BeaconSettings settings_;
  std::vector<MapLandmark> map_;
  std::vector<Eigen::Vector2d> real_;
  std::vector<double> offsets_, heights_;
  Pose2 truth_;
  double turn_ = 0;
  int steps_ = 0;
};

}  // namespace waymark::test
