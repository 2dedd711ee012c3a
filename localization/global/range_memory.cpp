// SPDX-License-Identifier: Apache-2.0
#include "localization/global/range_memory.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "core/covariance.hpp"

namespace waymark::localization {
namespace {

constexpr std::size_t kMaxRanges = 120;
constexpr double kMaxDriven = 100, kSpacing = 0.5;  // m

}  // namespace

void RangeMemory::predict(const BodyMotion& motion) {
  driven_ += motion.step.at().norm();
  if (!looks_.empty()) motion_ = compose(motion_, motion);
}

void RangeMemory::add(const SightingSet& seen) {
  std::vector<EarlierRange> fresh;
  for (const SeenLandmark& s : seen.sightings) {
    if (!s.is_valid() || s.bearing || !s.identity) continue;
    const auto [last, first] = measured_at_.try_emplace(*s.identity, driven_);
    if (!first && driven_ - last->second < kSpacing) continue;
    last->second = driven_;
    fresh.push_back({.range = *s.range, .sd = s.range_sd, .landmark = *s.identity});
  }
  if (fresh.empty()) return;
  count_ += fresh.size();
  looks_.push_back({std::exchange(motion_, {}), driven_, seen.robot_from_sensor, std::move(fresh)});
  while (looks_.size() > 1 && (count_ > kMaxRanges || driven_ - looks_.front().driven > kMaxDriven)) {
    count_ -= looks_.front().ranges.size();
    looks_.pop_front();
  }
}

std::vector<EarlierRange> RangeMemory::recall() const {
  std::vector<EarlierRange> all;
  BodyMotion since = motion_;
  for (auto look = looks_.rbegin(); look != looks_.rend(); ++look) {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-since.step.yaw).toRotationMatrix();
    const Eigen::Matrix3d motion = turn * positive_part(since.covariance) * turn.transpose();
    for (EarlierRange range : look->ranges) {
      range.from = (inverse(since.step) * look->mount).at();
      range.motion = motion;
      all.push_back(range);
    }
    since = compose(look->before, since);
  }
  std::ranges::reverse(all);
  return all;
}

}  // namespace waymark::localization
