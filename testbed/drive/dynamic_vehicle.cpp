// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/dynamic_vehicle.hpp"

#include <cmath>

namespace waymark::testbed {
namespace {

constexpr double kProgress = 0.2;  // m
constexpr double kPatience = 60;   // s

}  // namespace

DynamicVehicle::DynamicVehicle(const Terrain& terrain, std::span<const RockSolid> rocks,
                               const DriveSettings& settings, const localization::Pose2& start,
                               std::uint64_t seed)
    : settings_(settings),
      surface_(terrain, rocks),
      vehicle_(planning::find_vehicle(settings.moved_vehicle()), settings.dynamics.soil,
               settings.dynamics.gravity, surface_, start),
      random_(seed, "odometry") {
  const OdometryModel& model = settings.odometry;
  scale_ = model.perfect ? 1 : 1 + random_.normal(0, model.scale_sd);
  bias_ = model.perfect ? 0 : random_.normal(0, to_radians(model.yaw_bias_sd).value);
  now_.at = vehicle_.pose();
  progress_at_ = now_.at.plane.at();
}

DriveStep DynamicVehicle::step(const DriveCommand& command) {
  const OdometryModel& model = settings_.odometry;
  const double dt = 1 / model.rate, metres = std::abs(command.speed) * dt;
  vehicle_.drive(command.speed, command.turn, dt);
  const localization::TerrainPose at = vehicle_.pose();
  const Eigen::Vector2d moved = at.plane.at() - now_.at.plane.at();
  const double turned = localization::wrap_angle(at.plane.yaw - now_.at.plane.yaw) / dt;
  if (model.perfect) {
    now_.speed = moved.norm() / dt * (command.speed < 0 ? -1 : 1);
    now_.turn = turned;
  } else {
    now_.speed = command.speed * scale_ * (1 + random_.normal(0, model.speed_sd));
    now_.turn = turned + bias_ + random_.normal(0, to_radians(model.yaw_sd).value) * std::sqrt(metres) / dt;
  }
  const DriveStep before = now_;
  now_ = {.t = static_cast<double>(++steps_) * dt, .at = at, .distance = before.distance + moved.norm()};
  without_progress_ += dt;
  if ((at.plane.at() - progress_at_).norm() > kProgress || metres == 0) {
    progress_at_ = at.plane.at();
    without_progress_ = 0;
  }
  return before;
}

std::string DynamicVehicle::mishap() const {
  if (vehicle_.tipped_over()) return "tipped over";
  return without_progress_ > kPatience ? "stuck" : "";
}

SteadySlip steady_slip(const planning::Vehicle& vehicle, const Soil& soil, double gravity, double climb,
                       double cross) {
  const planning::Support& wheel = vehicle.supports.front();
  const double weight = vehicle.mass * gravity / static_cast<double>(vehicle.supports.size());
  const WheelFooting footing = wheel_footing(soil, weight * std::cos(climb) * std::cos(cross),
                                             wheel.diameter.value / 2, wheel.width.value, false);
  const auto slip = [&](double newtons) { return slip_of_pull(newtons / footing.strength, footing); };
  return {slip(weight * std::sin(climb) + footing.resistance), slip(weight * std::sin(cross))};
}

}  // namespace waymark::testbed
