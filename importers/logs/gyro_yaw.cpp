// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/gyro_yaw.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::importers {
namespace {

/// Yaw since the first of a list of turn rates.
class IntegratedYaw {
 public:
  explicit IntegratedYaw(std::span<const TurnRate> rates) : rates_(rates), yaws_(rates.size(), 0) {
    for (std::size_t i = 1; i < rates.size(); ++i)
      yaws_[i] = yaws_[i - 1] + (rates[i].t - rates[i - 1].t) * (rates[i].rate + rates[i - 1].rate) / 2;
  }

  double at(double t) const {
    const auto next = std::ranges::upper_bound(rates_, t, {}, &TurnRate::t);
    if (next == rates_.begin()) return 0;
    const auto i = static_cast<std::size_t>(next - rates_.begin()) - 1;
    if (next == rates_.end()) return yaws_[i];
    const double part = (t - rates_[i].t) / (next->t - rates_[i].t);
    const double rate = rates_[i].rate + part * (next->rate - rates_[i].rate);
    return yaws_[i] + (t - rates_[i].t) * (rates_[i].rate + rate) / 2;
  }

 private:
  std::span<const TurnRate> rates_;
  std::vector<double> yaws_;
};

}  // namespace

std::vector<localization::StampedPose> with_yaw_of_gyro(std::vector<localization::StampedPose> poses,
                                                        std::span<const TurnRate> rates) {
  const IntegratedYaw yaw(rates);
  localization::Pose2 before;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const localization::Pose2 own = poses[i].pose;
    if (i > 0) {
      localization::Pose2 step = inverse(before) * own;
      step.yaw = localization::wrap_angle(yaw.at(poses[i].t) - yaw.at(poses[i - 1].t));
      const double c = std::cos(step.yaw / 2), s = std::sin(step.yaw / 2);
      const double x = c * step.x - s * step.y;
      step.y = s * step.x + c * step.y;
      step.x = x;
      poses[i].pose = poses[i - 1].pose * step;
    }
    before = own;
  }
  return poses;
}

double yaw_variance_per_second(std::span<const TurnRate> rates) {
  if (rates.size() < 2) return 0;
  double sum = 0;
  for (const TurnRate& rate : rates) sum += rate.variance;
  const auto count = static_cast<double>(rates.size());
  return sum / count * (rates.back().t - rates.front().t) / (count - 1);
}

void use_gyro_noise(localization::RobotLog& log, double variance_per_second) {
  constexpr double kBias = 0.005, kScaleSd = 0.01;
  log.odometry.emplace();
  log.odometry->yaw_per_metre = 0;
  log.odometry->yaw_per_radian = kScaleSd * kScaleSd;
  log.odometry->yaw_per_second = variance_per_second;
  log.drift.yaw_rate_sd = kBias;
}

}  // namespace waymark::importers
