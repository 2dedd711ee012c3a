// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/options.hpp"
#include "localization/body_motion.hpp"
namespace waymark {

/// How fast odometry goes wrong. Errors of successive readings are independent, so their variances grow in
/// proportion to the way and the turn: a sum of many small steps has the noise of one big one (other than in
/// Thrun et al. 2005, table 5.6, whose noise depends on how often the wheels are read).
struct OdometryNoise {
  double along_per_metre = 0.02;      ///< variance forward per metre driven, m^2/m
  double across_per_metre = 0.002;    ///< variance sideways (slip) per metre driven, m^2/m
  double yaw_per_metre = 0.002;       ///< variance of yaw per metre driven, rad^2/m
  double yaw_per_radian = 0.02;       ///< variance of yaw per radian turned, rad^2/rad
  double position_per_second = 1e-6;  ///< standing still is not certain either, m^2/s
  double yaw_per_second = 1e-6;       ///< rad^2/s

  void describe(OptionVisitor& option);
  bool operator==(const OdometryNoise&) const = default;
};

/// Differential drive: speeds held for `seconds`, along an exact arc. speed m/s forward, turn rad/s to the
/// left. `sideways` is for points of the body off the axle. Throws std::invalid_argument for values that are
/// not finite and for seconds < 0.
BodyMotion twist_motion(double speed, double sideways, double turn, double seconds,
                        const OdometryNoise& noise);

/// A car whose front wheels steer and whose encoder sits on a rear wheel, as at Victoria Park.
struct Ackermann {
  double wheelbase = 2.83;       ///< m, > 0
  double encoder_offset = 0.76;  ///< from the middle of the rear axle to the wheel measured, left, m
  double ahead = 0, left = 0;    ///< m from the middle of the rear axle to the point that is followed
};

/// Motion of the point that is followed. wheel_speed m/s of the encoder's wheel, steering rad to the left;
/// |steering| must be below 80 degrees. Throws std::invalid_argument.
BodyMotion ackermann_motion(const Ackermann& car, double wheel_speed, double steering, double seconds,
                            const OdometryNoise& noise);

/// A step measured as such (visual odometry, inertial navigation), with the noise of the distance.
BodyMotion step_motion(const Pose2& step, double seconds, const OdometryNoise& noise);

}  // namespace waymark
