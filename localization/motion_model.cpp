// SPDX-License-Identifier: Apache-2.0
#include "localization/motion_model.hpp"

#include <stdexcept>

namespace waymark::localization {
namespace {

Eigen::Matrix3d noise_of(double metres, double radians, double seconds, const OdometryNoise& n) {
  Eigen::Matrix3d q = Eigen::Matrix3d::Zero();
  q(0, 0) = n.along_per_metre * metres + n.position_per_second * seconds;
  q(1, 1) = n.across_per_metre * metres + n.position_per_second * seconds;
  q(2, 2) = n.yaw_per_metre * metres + n.yaw_per_radian * radians + n.yaw_per_second * seconds;
  return q;
}

// sin(a)/a and (1 - cos(a))/a, also at 0.
double sinc(double a) {
  return std::abs(a) < 1e-4 ? 1 - a * a / 6 : std::sin(a) / a;
}
double cosc(double a) {
  return std::abs(a) < 1e-4 ? a / 2 : (1 - std::cos(a)) / a;
}

}  // namespace

void OdometryNoise::describe(OptionVisitor& option) {
  option("along_per_metre", along_per_metre, {.help = "Variance forward per metre driven, m^2/m", .min = 0});
  option("across_per_metre", across_per_metre,
         {.help = "Variance sideways per metre driven, m^2/m", .min = 0});
  option("yaw_per_metre", yaw_per_metre, {.help = "Variance of yaw per metre driven, rad^2/m", .min = 0});
  option("yaw_per_radian", yaw_per_radian,
         {.help = "Variance of yaw per radian turned, rad^2/rad", .min = 0});
  option("position_per_second", position_per_second,
         {.help = "Variance of each coordinate per second, m^2/s", .min = 0});
  option("yaw_per_second", yaw_per_second, {.help = "Variance of yaw per second, rad^2/s", .min = 0});
}

BodyMotion twist_motion(double speed, double sideways, double turn, double seconds,
                        const OdometryNoise& noise) {
  if (!std::isfinite(speed) || !std::isfinite(sideways) || !std::isfinite(turn))
    throw std::invalid_argument("odometry is not a finite number");
  if (!(seconds >= 0)) throw std::invalid_argument("time runs backwards between two odometry readings");
  const double angle = turn * seconds, dx = speed * seconds, dy = sideways * seconds;
  const double s = sinc(angle), c = cosc(angle);
  return {{s * dx - c * dy, c * dx + s * dy, wrap_angle(angle)},
          noise_of(std::hypot(dx, dy), std::abs(angle), seconds, noise)};
}

BodyMotion ackermann_motion(const Ackermann& car, double wheel_speed, double steering, double seconds,
                            const OdometryNoise& noise) {
  if (!(car.wheelbase > 0)) throw std::invalid_argument("wheelbase must be above 0 m");
  if (!(std::abs(steering) < 1.4))
    throw std::invalid_argument("steering must be within +-80 degrees, in radians");
  const double slope = std::tan(steering);
  const double speed = wheel_speed / (1 - slope * car.encoder_offset / car.wheelbase);
  const double turn = speed * slope / car.wheelbase;
  return twist_motion(speed - turn * car.left, turn * car.ahead, turn, seconds, noise);
}

BodyMotion step_motion(const Pose2& step, double seconds, const OdometryNoise& noise) {
  if (!step.finite()) throw std::invalid_argument("odometry is not a finite number");
  if (!(seconds >= 0)) throw std::invalid_argument("time runs backwards between two odometry readings");
  return {step, noise_of(std::hypot(step.x, step.y), std::abs(step.yaw), seconds, noise)};
}

}  // namespace waymark::localization
