// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/bag_imu.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "importers/logs/gyro_yaw.hpp"

namespace waymark::importers {

void add_turn_rates(localization::RobotLog& log, const std::string& topic,
                    const std::vector<BagImu>& readings, const Eigen::Matrix3d& body_from_imu,
                    std::vector<localization::StampedPose>& poses, bool lacks_yaw) {
  std::vector<TurnRate> rates;
  for (const BagImu& one : readings)
    if (one.rate) rates.push_back({one.at.t, (body_from_imu * *one.rate).z(), one.rate_variance});
  if (rates.empty()) return;
  if (poses.empty() || !lacks_yaw || rates.size() < 2) {
    log.remarks.push_back(fmt::format("{} angular velocities of {} are not used: {}", rates.size(), topic,
                                      poses.empty() ? "there is no odometry"
                                      : !lacks_yaw  ? "the odometry has a yaw"
                                                    : "two are needed"));
    return;
  }
  poses = with_yaw_of_gyro(std::move(poses), rates);
  std::string remark =
      fmt::format("the odometry has no yaw: {} angular velocities of {} give it", rates.size(), topic);
  if (const double variance = yaw_variance_per_second(rates); variance > 0) {
    use_gyro_noise(log, variance);
  } else {
    remark += "; they state no covariance";
  }
  log.remarks.push_back(remark);
}

void add_headings(localization::RobotLog& log, const std::string& topic, const std::vector<BagImu>& readings,
                  const Eigen::Matrix3d& body_from_imu) {
  std::size_t used = 0, unstated = 0;
  for (const BagImu& one : readings) {
    if (!one.orientation) continue;
    if (!(one.yaw_variance > 0)) {
      ++unstated;
      continue;
    }
    const Eigen::Matrix3d world_from_body = one.orientation->toRotationMatrix() * body_from_imu.transpose();
    log.events.push_back(
        {one.at.t, localization::HeadingFix{std::atan2(world_from_body(1, 0), world_from_body(0, 0)),
                                            std::sqrt(one.yaw_variance)}});
    ++used;
  }
  if (used)
    log.remarks.push_back(
        fmt::format("{} orientations of {} are read as a compass; if its yaw does not start at east, --set "
                    "use_fixes=false "
                    "leaves it out",
                    used, topic));
  if (unstated)
    log.remarks.push_back(
        fmt::format("{} orientations of {} state no covariance and are not used", unstated, topic));
}

}  // namespace waymark::importers
