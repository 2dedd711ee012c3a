// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/random.hpp"

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

std::vector<DriveStep> drive_along(const Terrain& terrain, std::span<const Eigen::Vector2d> path,
                                   const DriveSettings& settings, std::uint64_t seed) {
  if (path.size() < 2) throw Error(ErrorCode::usage, "a drive needs a path of at least two points", "drive");
  const OdometryModel model = settings.odometry;
  const bool exact = model.perfect;
  Random random(seed, "odometry");
  const double scale = exact ? 1 : 1 + random.normal(0, model.scale_sd);
  const double bias = exact ? 0 : random.normal(0, to_radians(model.yaw_bias_sd).value);
  const double dt = 1 / model.rate, ahead = std::max(1.5, 2 * settings.speed);

  const Eigen::Vector2d first = path[std::min<std::size_t>(path.size() - 1, 4)] - path[0];
  localization::Pose2 pose{path[0].x(), path[0].y(), std::atan2(first.y(), first.x())};
  std::vector<DriveStep> steps;
  double driven = 0, waver = 0;
  std::size_t target = 0;
  const auto limit = static_cast<std::size_t>(3e5);
  for (std::size_t k = 0; k < limit; ++k) {
    const localization::TerrainPose at = require_pose(terrain, pose, settings.wheels);
    // The target point only moves forward, so that the path may cross itself and turn back.
    while (target + 1 < path.size() && (path[target] - pose.at()).norm() < ahead) ++target;
    const bool arrived = target + 1 == path.size() && (path[target] - pose.at()).norm() < ahead;
    steps.push_back({static_cast<double>(k) * dt, at, driven, 0, 0});
    if (arrived) return steps;

    const Eigen::Vector2d to = path[target] - pose.at();
    const double off = localization::wrap_angle(std::atan2(to.y(), to.x()) - pose.yaw);
    const double wheels = settings.speed * std::max(0.25, std::cos(off));
    double turn = 2 * std::sin(off) / to.norm() * wheels;
    if (std::abs(off) > 1.4) turn = std::copysign(0.5, off);
    turn = std::clamp(turn, -0.6, 0.6);
    const double metres = wheels * dt;
    double lost = 0, aside = 0;
    if (!exact) {
      const double fade = std::exp(-metres / kSlipLength);
      waver = fade * waver + std::sqrt(1 - fade * fade) * random.normal(0, model.slip_sd);
      lost = std::clamp(model.slip - model.slip_per_slope * std::sin(at.pitch) + waver, -0.5, 0.95);
      aside = -model.side_slip * std::sin(at.roll);
    }
    const double forward = metres * (1 - lost) * std::cos(at.pitch), sideways = metres * aside;
    steps.back().speed = exact ? forward / dt : wheels * scale * (1 + random.normal(0, model.speed_sd));
    steps.back().turn =
        exact ? turn
              : turn + bias + random.normal(0, to_radians(model.yaw_sd).value) * std::sqrt(metres) / dt;
    // Arc of a differential drive, as integrated by odometry.
    const double angle = turn * dt, half = angle / 2;
    const double chord = std::abs(half) > 1e-9 ? std::sin(half) / half : 1;
    const double c = std::cos(half) * chord, s = std::sin(half) * chord;
    pose = pose * localization::Pose2{c * forward - s * sideways, s * forward + c * sideways, angle};
    driven += std::hypot(forward, sideways);
  }
  throw Error(ErrorCode::usage, "the drive does not reach the end of its path", "drive",
              "a slower turn needs more room: fewer waypoints, or more speed");
}

}  // namespace waymark::testbed
