// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>
#include "core/random.hpp"
#include "testbed/drive/drive_log.hpp"
namespace waymark::testbed {

/// Lines of a log (docs/reference/log_format.md), each with \n. Reading `i` of a sensor at step `i` has a
/// random stream of its own, so it does not depend on other sensors and steps. Only settings, seed and
/// targets of the world are used.
///
/// The header states the noise of odometry on ground as at the poses of `steps`, driven or planned.
std::string log_header(const DriveWorld& world, const LogCrs& place, const localization::Pose2& start,
                       std::span<const DriveStep> steps);
/// Returns the odometry noise of `steps` as the header states it, a JSON object.
std::string odometry_noise_json(const DriveSettings& settings, std::span<const DriveStep> steps);
/// Returns the odometry until the next step, and the true pose if the log has it.
std::string odometry_lines(const DriveWorld& world, const LogCrs& place, const DriveStep& step);
/// Returns the poses of the line scanners on the vehicle.
std::vector<localization::Pose2> laser_mounts(const DriveSettings& settings);
/// `which`: index of the mount.
std::string laser_line(const DriveWorld& world, std::size_t i, const DriveStep& step, std::size_t which);
std::string depth_line(const DriveWorld& world, std::size_t i, const DriveStep& step);
std::string camera_line(const DriveWorld& world, std::size_t i, const DriveStep& step);
std::string panorama_line(const DriveWorld& world, std::size_t i, const DriveStep& step);

/// GNSS whose correlated error is an Ornstein-Uhlenbeck process; missing fixes advance it, too.
class GnssReceiver {
 public:
  GnssReceiver(const GnssModel& model, std::uint64_t seed);
  /// Returns the next fix; empty if it is missing.
  std::string line(const DriveStep& step, const LogCrs& place);

 private:
  GnssModel model_;
  Random random_;
  Eigen::Vector2d bias_;
};

/// Sensors of a vehicle that is on its drive. The readings are those of drive_log(). The world must outlive
/// it.
class DriveSensors {
 public:
  DriveSensors(const DriveWorld& world, LogCrs place);
  DriveSensors(const DriveSensors&) = delete;
  /// Returns the lines of all sensors that measure at step `i`. Steps are given in their order.
  std::vector<std::string> lines(std::size_t i, const DriveStep& step);

 private:
  struct Sensor {
    double every;
    std::function<std::string(std::size_t, const DriveStep&)> line;
    double next = 0;
  };
  const DriveWorld& world_;
  LogCrs place_;
  GnssReceiver receiver_;
  std::vector<Sensor> sensors_;
};

}  // namespace waymark::testbed
