// SPDX-License-Identifier: Apache-2.0
#include "planning/landmark_watch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark::planning {
namespace {

constexpr double kMaxSd = 1;           // m, of a pose that says where landmarks should be
constexpr double kInner = 2.0 / 3;     // of the range
constexpr double kEdge = 0.1;          // rad at each side of the view
constexpr double kIndependent = 0.5;   // of the detection probability: misses of one landmark repeat
constexpr double kCertain = 1e9;       // log odds of a landmark that was matched
constexpr double kGoneLogOdds = -2.2;  // probability 0.1

}  // namespace

LandmarkWatch::LandmarkWatch(localization::LandmarkGrid map, LandmarkSensing sensing)
    : map_(std::move(map)), sensing_(std::move(sensing)) {}

void LandmarkWatch::add(const localization::PoseEstimate& robot,
                        std::span<const localization::Match> matches) {
  for (const localization::Match& match : matches)
    if (match.verdict == localization::Verdict::matched) log_odds_[match.key] = kCertain;
  if (!(position_sd(symmetric(robot.covariance)) <= kMaxSd)) return;
  const SensorCoverage& sensor = sensing_.coverage;
  const double half_view = std::min(sensor.view / 2 * kRadiansPerDegree - kEdge, std::numbers::pi);
  map_.near(robot.pose.at(), kInner * sensor.range, [&](std::uint32_t i) {
    const localization::MapLandmark& landmark = map_[i];
    if (landmark.outweighed) return;  // no filter looks for it
    const Eigen::Vector2d to = landmark.at - robot.pose.at();
    if (sensor.view < 360 &&
        std::abs(localization::wrap_angle(std::atan2(to.y(), to.x()) - robot.pose.yaw)) > half_view)
      return;
    if (sensing_.visible && !sensing_.visible(robot.pose, landmark.at)) return;
    const double q = std::clamp(landmark.quality, 0.01, 0.99);
    double& odds = log_odds_.try_emplace(landmark.key, std::log(q / (1 - q))).first->second;
    if (odds < kCertain)
      odds += std::log(1 - kIndependent * detection_probability(sensor, to.norm(), landmark.diameter));
  });
}

std::vector<localization::LandmarkKey> LandmarkWatch::gone() const {
  std::vector<localization::LandmarkKey> keys;
  for (const auto& [key, odds] : log_odds_)
    if (odds < kGoneLogOdds) keys.push_back(key);
  std::ranges::sort(keys);
  return keys;
}

localization::LandmarkGrid map_without(const localization::LandmarkGrid& map,
                                       std::span<const localization::LandmarkKey> keys) {
  std::vector<localization::MapLandmark> kept;
  for (const localization::MapLandmark& landmark : map.landmarks())
    if (!std::ranges::binary_search(keys, landmark.key)) kept.push_back(landmark);
  return localization::LandmarkGrid(std::move(kept));
}

}  // namespace waymark::planning
