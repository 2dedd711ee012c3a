// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "core/random.hpp"
#include "geo/terrain.hpp"
#include "testbed/drive/drive_settings.hpp"
namespace waymark::testbed {

/// State of a simulated drive: true pose, and the odometry reading until the next step.
struct DriveStep {
  double t = 0;
  localization::TerrainPose at;
  double distance = 0;         ///< metres driven along the route
  double speed = 0, turn = 0;  ///< measured by odometry, m/s and rad/s, until the next step
};

/// What a vehicle is asked to do until the next step.
struct DriveCommand {
  double speed = 0, turn = 0;  ///< of the wheels, m/s; to the left, rad/s
};

/// Follows a path by pure pursuit (Coulter 1992), whatever pose it is given: the true or an estimated one.
class PathPursuit {
 public:
  /// `speed`: metres per second.
  PathPursuit(std::vector<Eigen::Vector2d> path, double speed);

  /// Returns the command at a pose; `std::nullopt` at the end of the path. The target only moves forward, so
  /// that the path may cross itself and turn back.
  std::optional<DriveCommand> command(const localization::Pose2& pose);

  const std::vector<Eigen::Vector2d>& path() const { return path_; }
  std::size_t target() const { return target_; }

 private:
  std::vector<Eigen::Vector2d> path_;
  double speed_;
  std::size_t target_ = 0;
};

/// Vehicle on a terrain with slip that depends on the slope, and odometry with errors. Deterministic for a
/// seed. The terrain and the settings must outlive it.
class SlippingVehicle {
 public:
  /// Throws Error{usage} if a wheel is not on the terrain, as step() does.
  SlippingVehicle(const Terrain& terrain, const DriveSettings& settings, const localization::Pose2& start,
                  std::uint64_t seed);

  /// Returns the state; its odometry reading is that of the last step.
  const DriveStep& now() const { return now_; }
  /// Drives for one period of the odometry. Returns the state before it, with the odometry reading.
  DriveStep step(const DriveCommand& command);

 private:
  const Terrain& terrain_;
  const DriveSettings& settings_;
  Random random_;
  double scale_, bias_, waver_ = 0;
  std::size_t steps_ = 0;
  localization::Pose2 pose_;
  DriveStep now_;
};

}  // namespace waymark::testbed
