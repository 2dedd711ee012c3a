// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include "core/random.hpp"
#include "geo/terrain.hpp"
#include "testbed/drive/drive_settings.hpp"
#include "testbed/landing/rock_solid.hpp"
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

/// Vehicle that moves and measures its odometry. Deterministic for a seed.
class VehicleMotion {
 public:
  virtual ~VehicleMotion() = default;

  /// Returns the state; its odometry reading is that of the last step.
  virtual const DriveStep& now() const = 0;
  /// Drives for one period of the odometry. Returns the state before it, with the odometry reading. Throws
  /// Error{usage} if a wheel leaves the terrain.
  virtual DriveStep step(const DriveCommand& command) = 0;
  /// Returns why the vehicle cannot go on, as a predicate ("tipped over"); empty while it can.
  virtual std::string mishap() const { return {}; }
};

/// Returns a WheeledVehicle if the settings ask for dynamics, a SlippingVehicle otherwise. Terrain, rocks and
/// settings must outlive it. Throws Error{usage} if a wheel is not on the terrain.
std::unique_ptr<VehicleMotion> make_motion(const Terrain& terrain, std::span<const RockSolid> rocks,
                                           const DriveSettings& settings, const localization::Pose2& start,
                                           std::uint64_t seed);

/// Vehicle that stands on the plane under its wheels, with slip that depends on the slope. The terrain and
/// the settings must outlive it.
class SlippingVehicle final : public VehicleMotion {
 public:
  SlippingVehicle(const Terrain& terrain, const DriveSettings& settings, const localization::Pose2& start,
                  std::uint64_t seed);

  const DriveStep& now() const override { return now_; }
  DriveStep step(const DriveCommand& command) override;

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
