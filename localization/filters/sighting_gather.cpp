// SPDX-License-Identifier: Apache-2.0
// What the poses of a cloud share of a set's landmarks.
#include <algorithm>

#include "localization/filters/sighting_score.hpp"

namespace waymark {
namespace {

constexpr double kSlack = 1e-6;     // m: no rounding leaves out a landmark
constexpr double kShortTurn = 0.5;  // rad: series tell sines and cosines of headings off the middle one

}  // namespace

SightingScore::Cloud SightingScore::cloud_of(std::span<const Pose2> poses) {
  if (poses.empty()) return {};
  Eigen::AlignedBox2d box;
  double right = 0, left = 0;
  for (const Pose2& p : poses) {
    box.extend(p.at());
    const double turn = wrapped(p.yaw - poses[0].yaw);
    right = std::min(right, turn), left = std::max(left, turn);
  }
  const Eigen::Vector2d middle = box.center();
  return {.middle = {middle.x(), middle.y(), wrapped(poses[0].yaw + (left + right) / 2)},
          .half = box.sizes() / 2 + Eigen::Vector2d::Constant(kSlack),
          .turn = (left - right) / 2 + kSlack};
}

void SightingScore::gather(std::span<const Pose2> poses) {
  cloud_ = cloud_of(poses);
  const double turned = robot_from_sensor_.at().norm() * std::min(cloud_.turn, 2.0);
  alike_ = !paper_ && !options_.expect_unseen && cloud_.turn < kShortTurn;
  for (Prepared& p : prepared_) {
    if (p.known) continue;
    gather(p, cloud_.middle * robot_from_sensor_, cloud_.half.norm() + turned + kSlack);
    alike_ = alike_ && p.gathered;
  }
}

// `sensor`: that of the cloud's middle; the others are within `radius` of it.
void SightingScore::gather(Prepared& p, const Pose2& sensor, double radius) {
  p.candidates.clear();
  const double swing = p.seen.range ? *p.seen.range * std::min(cloud_.turn, 2.0) : 0;
  // Of a wide cloud each particle has landmarks of its own.
  p.gathered = radius + swing < 4 * p.radius;
  if (!p.gathered) return;
  const double along = sensor.yaw + p.seen.bearing;
  const Eigen::Vector2d out(std::cos(along), std::sin(along));
  const Eigen::Vector2d centre = sensor.at() + p.seen.range.value_or(0) * out;
  map_->near(centre, p.radius + radius + swing, [&](std::uint32_t i) {
    const MapLandmark& l = (*map_)[i];
    const Eigen::Vector2d d = l.at - sensor.at();
    const double away = d.norm();
    if (p.seen.range) {
      if (std::abs(away - *p.seen.range) > p.radius + radius) return;
    } else if (away > 2 * radius) {
      const double nearest = away - radius, sd = map_->largest_sd() / nearest;
      const double most = std::sqrt(p.gate * (p.bearing_variance + sd * sd)) + cloud_.turn +
                          std::asin(radius / away) + kSlack;
      if (std::abs(std::atan2(out.x() * d.y() - out.y() * d.x(), out.dot(d))) > most) return;
    }
    if (const auto alike = likeness(p, i)) p.candidates.push_back({i, l.at, l.covariance, *alike});
  });
}

}  // namespace waymark
