// SPDX-License-Identifier: Apache-2.0
// Candidate landmarks shared by the poses of a cloud.
#include <algorithm>

#include "core/covariance.hpp"
#include "localization/filters/sighting_score.hpp"

namespace waymark::localization {
namespace {

constexpr double kSlack = 1e-6;     // m: rounding omits no landmark
constexpr double kShortTurn = 0.5;  // rad off the middle heading: sine and cosine by series

}  // namespace

SightingScore::Cloud SightingScore::bounding_cloud(std::span<const Pose2> poses) {
  if (poses.empty()) return {};
  Eigen::AlignedBox2d box;
  double right = 0, left = 0;
  for (const Pose2& p : poses) {
    box.extend(p.at());
    const double turn = wrap_angle(p.yaw - poses[0].yaw);
    right = std::min(right, turn), left = std::max(left, turn);
  }
  const Eigen::Vector2d middle = box.center();
  return {.middle = {middle.x(), middle.y(), wrap_angle(poses[0].yaw + (left + right) / 2)},
          .half = box.sizes() / 2 + Eigen::Vector2d::Constant(kSlack),
          .turn = (left - right) / 2 + kSlack};
}

void SightingScore::prefetch(std::span<const Pose2> poses) {
  cloud_ = bounding_cloud(poses);
  const double turned = robot_from_sensor_.at().norm() * std::min(cloud_.turn, 2.0);
  shared_candidates_ = !paper_ && !options_.expect_unseen && cloud_.turn < kShortTurn;
  for (Prepared& p : prepared_) {
    shared_candidates_ = shared_candidates_ && !p.turns;
    if (p.known) continue;
    prefetch(p, cloud_.middle * robot_from_sensor_, cloud_.half.norm() + turned + kSlack);
    shared_candidates_ = shared_candidates_ && p.prefetched;
  }
}

// `sensor`: that of the cloud's middle; the others are within `radius` metres of it.
void SightingScore::prefetch(Prepared& p, const Pose2& sensor, double radius) {
  p.candidates.clear();
  p.prefetched = false;
  if (p.seen.extent) return;  // of a line each pose sees another piece
  const double swing = p.ahead * std::min(cloud_.turn, 2.0);
  // Each particle of a wide cloud has its own landmarks.
  p.prefetched = radius + swing < 4 * p.radius;
  if (!p.prefetched) return;
  const double along = sensor.yaw + p.seen.bearing.value_or(0);
  const Eigen::Vector2d out(std::cos(along), std::sin(along));
  const Eigen::Vector2d centre = sensor.at() + p.ahead * out;
  map_->near(centre, p.radius + radius + swing, [&](std::uint32_t i) {
    const MapLandmark& l = (*map_)[i];
    const Eigen::Vector2d d = l.at - sensor.at();
    const double away = d.norm();
    if (p.seen.range && std::abs(away - *p.seen.range) > p.radius + radius) return;
    const Eigen::Matrix2d covariance = map_covariance(i);
    const double sd = largest_sd(covariance);
    const GateBounds bounds(p, sd);
    if (p.seen.range && std::abs(away - *p.seen.range) > bounds.off + radius) return;
    if (p.seen.bearing && away > 2 * radius) {
      const double nearest_sd = sd / (away - radius);
      const double max_turn = std::sqrt(p.gate * (p.bearing_variance + nearest_sd * nearest_sd)) +
                              cloud_.turn + std::asin(radius / away) + kSlack;
      if (std::abs(std::atan2(out.x() * d.y() - out.y() * d.x(), out.dot(d))) > max_turn) return;
    }
    if (const auto alike = pose_free_terms(p, i))
      p.candidates.push_back({i, l.at, covariance, bounds, *alike});
  });
}

}  // namespace waymark::localization
