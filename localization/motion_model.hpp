// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/options.hpp"
#include "localization/body_motion.hpp"
namespace waymark::localization {

/// Growth of odometry errors. Errors of successive readings are independent, so their variances are
/// proportional to the distance and the turn: many small steps have the noise of one large step. Differs
/// from Thrun et al. 2005, table 5.6, where the noise depends on how often the wheels are read.
struct OdometryNoise {
  double along_per_metre = 0.02;      ///< variance forward per metre driven, m^2/m
  double across_per_metre = 0.002;    ///< variance sideways (slip) per metre driven, m^2/m
  double yaw_per_metre = 0.002;       ///< variance of yaw per metre driven, rad^2/m
  double yaw_per_radian = 0.02;       ///< variance of yaw per radian turned, rad^2/rad
  double position_per_second = 1e-6;  ///< m^2/s; also while the robot stands
  double yaw_per_second = 1e-6;       ///< rad^2/s

  void describe(OptionVisitor& option);
  bool operator==(const OdometryNoise&) const = default;
};

/// Returns the motion of a differential drive at constant speeds over `seconds`, along an exact arc.
/// `speed` is m/s forward, `turn` rad/s to the left; `sideways`, m/s left, is for points of the body off
/// the axle. Throws std::invalid_argument for values that are not finite and for seconds < 0.
BodyMotion twist_motion(double speed, double sideways, double turn, double seconds,
                        const OdometryNoise& noise);

/// A car whose front wheels steer and whose encoder sits on a rear wheel, as at Victoria Park.
struct Ackermann {
  double wheelbase = 2.83;       ///< m, > 0
  double encoder_offset = 0.76;  ///< m to the left, from the middle of the rear axle to the measured wheel
  double ahead = 0, left = 0;    ///< m from the middle of the rear axle to the reference point
};

/// Returns the motion of the car's reference point. `wheel_speed` is that of the encoder's wheel, m/s;
/// `steering` is rad to the left, |steering| below 80 degrees. Throws std::invalid_argument.
BodyMotion ackermann_motion(const Ackermann& car, double wheel_speed, double steering, double seconds,
                            const OdometryNoise& noise);

/// Returns a measured step (visual odometry, inertial navigation) with the noise of its distance.
BodyMotion step_motion(const Pose2& step, double seconds, const OdometryNoise& noise);

}  // namespace waymark::localization
