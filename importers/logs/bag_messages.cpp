// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/bag_messages.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "importers/logs/robot_readings.hpp"

namespace waymark::importers {
namespace {

template <std::size_t Count>
std::array<double, Count> numbers(CdrReader& in) {
  std::array<double, Count> all;
  for (double& one : all) one = in.number<double>();
  return all;
}

/// Returns a variance of a message; 0 if it states none.
double stated(double variance) {
  return std::isfinite(variance) && variance > 0 ? variance : 0;
}

// Covariances of sensor_msgs: a first element of -1 says that the quantity is not measured.
bool is_measured(const Covariance3& covariance) {
  return covariance[0] != -1;
}

}  // namespace

BagStamp read_stamp(CdrReader& in, std::int64_t received) {
  const auto seconds = in.number<std::int32_t>();
  const auto nanoseconds = in.number<std::uint32_t>();
  const double t = seconds + nanoseconds / 1e9;
  return {t != 0 ? t : static_cast<double>(received) / 1e9, in.text()};  // 0: drivers that set no stamp
}

Eigen::Isometry3d read_transform(CdrReader& in) {
  Eigen::Vector3d at;
  for (double& v : at) v = in.number<double>();
  Eigen::Quaterniond turn;
  for (double& v : turn.coeffs()) v = in.number<double>();  // x y z w, as Eigen keeps them
  if (!(at.allFinite() && std::abs(turn.norm() - 1) < 0.1))
    throw std::runtime_error("a pose is not finite or its quaternion is not of length 1");
  return Eigen::Translation3d(at) * turn.normalized();
}

BagOdometry read_odometry(const BagMessage& message) {
  CdrReader in(message.bytes);
  BagOdometry odometry{.at = read_stamp(in, message.received), .body = in.text(), .pose = read_transform(in)};
  odometry.yaw_variance = numbers<36>(in)[35];  // x, y, z and turns about x, y, z
  return odometry;
}

BagPose read_pose(const BagMessage& message, bool has_covariance) {
  CdrReader in(message.bytes);
  BagPose pose{.at = read_stamp(in, message.received), .pose = read_transform(in)};
  if (has_covariance) pose.yaw_variance = numbers<36>(in)[35];
  return pose;
}

BagImu read_imu(const BagMessage& message) {
  CdrReader in(message.bytes);
  BagImu imu{.at = read_stamp(in, message.received), .rate = {}, .orientation = {}};
  Eigen::Quaterniond orientation;
  for (double& v : orientation.coeffs()) v = in.number<double>();
  const auto orientation_covariance = numbers<9>(in);
  const auto rate = numbers<3>(in);
  const auto rate_covariance = numbers<9>(in);
  if (is_measured(orientation_covariance)) {
    if (!(std::abs(orientation.norm() - 1) < 0.1))
      throw std::runtime_error("the quaternion of an orientation is not of length 1");
    imu.orientation = orientation.normalized();
    imu.yaw_variance = stated(orientation_covariance[8]);
  }
  if (is_measured(rate_covariance)) {
    imu.rate.emplace(rate[0], rate[1], rate[2]);
    if (!imu.rate->allFinite()) throw std::runtime_error("an angular velocity is not finite");
    imu.rate_variance = stated(rate_covariance[8]);
  }
  return imu;
}

BagFix read_fix(const BagMessage& message) {
  constexpr std::int8_t kNoFix = -1;
  CdrReader in(message.bytes);
  BagFix fix{.at = read_stamp(in, message.received)};
  const auto status = in.number<std::int8_t>();
  in.number<std::uint16_t>();  // systems of satellites
  fix.latitude = in.number<double>(), fix.longitude = in.number<double>();
  in.number<double>();                            // altitude
  const Covariance3 covariance = numbers<9>(in);  // east, north, up; m^2
  const auto type = in.number<std::uint8_t>();
  if (status <= kNoFix) return fix;
  if (!(std::abs(fix.latitude) <= 90 && std::abs(fix.longitude) <= 360))
    throw std::runtime_error(
        fmt::format("a position is no latitude and longitude: {}, {}", fix.latitude, fix.longitude));
  fix.is_fix = true;
  fix.covariance = horizontal_covariance(covariance, type);
  return fix;
}

}  // namespace waymark::importers
