// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/vehicle_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "testbed/drive/dynamic_vehicle.hpp"

namespace waymark::testbed {
namespace {

constexpr double kSlipLength = 5;  // metres, correlation length of the slip

localization::TerrainPose require_pose(const Terrain& terrain, const localization::Pose2& pose,
                                       const localization::Wheels& wheels) {
  const auto at = localization::pose_on_terrain(
      [&](const Eigen::Vector2d& p) { return terrain.height(p.x(), p.y()); }, pose, wheels);
  if (!at)
    throw Error(ErrorCode::usage,
                fmt::format("the drive leaves the terrain at {:.1f}, {:.1f}", pose.x, pose.y), "drive",
                "enlarge the site (ground.width, ground.height), or move the waypoints");
  return *at;
}

}  // namespace

PathPursuit::PathPursuit(std::vector<Eigen::Vector2d> path, double speed)
    : path_(std::move(path)), speed_(speed) {}

std::optional<DriveCommand> PathPursuit::command(const localization::Pose2& pose) {
  const double ahead = std::max(1.5, 2 * speed_);
  while (target_ + 1 < path_.size() && (path_[target_] - pose.at()).norm() < ahead) ++target_;
  if (target_ + 1 == path_.size() && (path_[target_] - pose.at()).norm() < ahead) return {};
  const Eigen::Vector2d to = path_[target_] - pose.at();
  const double off = localization::wrap_angle(std::atan2(to.y(), to.x()) - pose.yaw);
  const double wheels = speed_ * std::max(0.25, std::cos(off));
  double turn = 2 * std::sin(off) / to.norm() * wheels;
  if (std::abs(off) > 1.4) turn = std::copysign(0.5, off);
  return DriveCommand{wheels, std::clamp(turn, -0.6, 0.6)};
}

std::unique_ptr<VehicleMotion> make_motion(const Terrain& terrain, std::span<const RockSolid> rocks,
                                           const DriveSettings& settings, const localization::Pose2& start,
                                           std::uint64_t seed) {
  if (settings.dynamics.on) return std::make_unique<DynamicVehicle>(terrain, rocks, settings, start, seed);
  return std::make_unique<SlippingVehicle>(terrain, settings, start, seed);
}

SlippingVehicle::SlippingVehicle(const Terrain& terrain, const DriveSettings& settings,
                                 const localization::Pose2& start, std::uint64_t seed)
    : terrain_(terrain), settings_(settings), random_(seed, "odometry"), pose_(start) {
  const OdometryModel& model = settings.odometry;
  scale_ = model.perfect ? 1 : 1 + random_.normal(0, model.scale_sd);
  bias_ = model.perfect ? 0 : random_.normal(0, to_radians(model.yaw_bias_sd).value);
  now_.at = require_pose(terrain_, pose_, settings.wheels);
}

DriveStep SlippingVehicle::step(const DriveCommand& command) {
  const OdometryModel& model = settings_.odometry;
  const bool exact = model.perfect;
  const double dt = 1 / model.rate, metres = command.speed * dt;
  double lost = 0, aside = 0;
  if (!exact) {
    const double fade = std::exp(-metres / kSlipLength);
    waver_ = fade * waver_ + std::sqrt(1 - fade * fade) * random_.normal(0, model.slip_sd);
    lost = std::clamp(model.slip - model.slip_per_slope * std::sin(now_.at.pitch) + waver_, -0.5, 0.95);
    aside = -model.side_slip * std::sin(now_.at.roll);
  }
  const double forward = metres * (1 - lost) * std::cos(now_.at.pitch), sideways = metres * aside;
  now_.speed = exact ? forward / dt : command.speed * scale_ * (1 + random_.normal(0, model.speed_sd));
  now_.turn = exact ? command.turn
                    : command.turn + bias_ +
                          random_.normal(0, to_radians(model.yaw_sd).value) * std::sqrt(metres) / dt;
  const DriveStep before = now_;
  // Arc of a differential drive, as integrated by odometry.
  const double angle = command.turn * dt, half = angle / 2;
  const double chord = std::abs(half) > 1e-9 ? std::sin(half) / half : 1;
  const double c = std::cos(half) * chord, s = std::sin(half) * chord;
  pose_ = pose_ * localization::Pose2{c * forward - s * sideways, s * forward + c * sideways, angle};
  now_ = {.t = static_cast<double>(++steps_) * dt,
          .at = require_pose(terrain_, pose_, settings_.wheels),
          .distance = before.distance + std::hypot(forward, sideways)};
  return before;
}

}  // namespace waymark::testbed
