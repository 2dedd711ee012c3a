// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/odometry_errors.hpp"

#include <algorithm>
#include <cmath>

#include "testbed/drive/dynamic_vehicle.hpp"

namespace waymark::testbed {
namespace {

constexpr double kDriftDistance = 10;    // m: between the 5 m of the model's slip and the length of slopes
constexpr double kRoughnessSlip = 0.02;  // of wheels that roll over stones and steps
constexpr double kRounding = 1e-8;       // m^2/m and rad^2/m: of the log's digits and the integration of arcs

}  // namespace

OdometryErrors odometry_errors(const DriveSettings& settings, std::span<const DriveStep> steps) {
  const OdometryModel& model = settings.odometry;
  OdometryErrors errors{.noise = {.along_per_metre = kRounding,
                                  .across_per_metre = kRounding,
                                  .yaw_per_metre = kRounding,
                                  .yaw_per_radian = kRounding,
                                  .position_per_second = kRounding,
                                  .yaw_per_second = kRounding},
                        .drift = {}};
  if (model.perfect) return errors;
  double pitch = 0, roll = 0;
  for (const DriveStep& step : steps) {
    pitch += std::pow(std::sin(step.at.pitch), 2);
    roll += std::pow(std::sin(step.at.roll), 2);
  }
  const double count = static_cast<double>(std::max<std::size_t>(1, steps.size()));
  pitch = std::sqrt(pitch / count), roll = std::sqrt(roll / count);
  const double yaw_sd = to_radians(model.yaw_sd).value;
  errors.noise.along_per_metre += model.speed_sd * model.speed_sd * settings.speed / model.rate;
  errors.noise.yaw_per_metre += yaw_sd * yaw_sd;
  if (settings.dynamics.on) {
    const planning::Vehicle vehicle = planning::find_vehicle(settings.moved_vehicle());
    const auto slip = [&](double climb, double cross) {
      return steady_slip(vehicle, settings.dynamics.soil, settings.dynamics.gravity, climb, cross);
    };
    const SteadySlip level = slip(0, 0), sloping = slip(std::asin(pitch), std::asin(roll));
    errors.drift = {.scale_sd = std::hypot(level.along, model.scale_sd),
                    .slip_sd = std::hypot(sloping.along - level.along, kRoughnessSlip),
                    .sideways_sd = sloping.across,
                    .drift_distance = kDriftDistance,
                    .yaw_rate_sd = to_radians(model.yaw_bias_sd).value};
    return errors;
  }
  errors.drift = {.scale_sd = std::hypot(model.slip, model.scale_sd),
                  .slip_sd = std::hypot(model.slip_per_slope * pitch, model.slip_sd),
                  .sideways_sd = model.side_slip * roll,
                  .drift_distance = kDriftDistance,
                  .yaw_rate_sd = to_radians(model.yaw_bias_sd).value};
  return errors;
}

}  // namespace waymark::testbed
