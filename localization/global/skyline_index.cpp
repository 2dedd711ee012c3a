// SPDX-License-Identifier: Apache-2.0
#include "localization/global/skyline_index.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "localization/global/skyline_view.hpp"

namespace waymark {
namespace {

constexpr int kSectors = 180;
constexpr double kBelow = 0.012;  // rad below the highest summit of its sector: it cannot be on the horizon

int sector_of(double azimuth) {
  const int s = static_cast<int>(std::floor(azimuth / (2 * std::numbers::pi) * kSectors));
  return ((s % kSectors) + kSectors) % kSectors;
}

/// As clears_ground, with steps that grow with distance and a slack for not knowing the place to a step.
bool may_clear(const Eigen::Vector3d& eye, const Eigen::Vector3d& top, const GroundHeight& ground,
               const SkylineOptions& o, double slack) {
  const Eigen::Vector2d d = (top - eye).head<2>();
  const double distance = d.norm(), margin = 3 * o.place_sd + 100;
  const double rise =
      (top.z() + slack - curvature_drop(distance, o.body_radius, o.refraction) - eye.z()) / distance;
  for (double t = o.step / 2 + 100; t < distance - margin;
       t += std::max(90.0, 0.02 * std::min(t, distance - t))) {
    const auto height = ground(eye.head<2>() + d * (t / distance));
    if (height && *height - curvature_drop(t, o.body_radius, o.refraction) > eye.z() + rise * t + slack)
      return false;
  }
  return true;
}

}  // namespace

SkylineIndex::SkylineIndex(std::vector<SkylineSummit> summits, GroundHeight ground,
                           const SkylineOptions& options)
    : summits_(std::move(summits)), ground_(std::move(ground)), options_(options) {
  for (const SkylineSummit& s : summits_) bounds_.extend(s.at);
  if (summits_.size() < 3) return;
  for (double y = bounds_.min().y(); y <= bounds_.max().y(); y += options_.step)
    for (double x = bounds_.min().x(); x <= bounds_.max().x(); x += options_.step)
      if (auto place = look_round({x, y})) places_.push_back(std::move(*place));
}

std::optional<SkylineIndex::Place> SkylineIndex::look_round(const Eigen::Vector2d& at) const {
  const auto height = ground_(at);
  if (!height) return {};
  Place place{.at = at, .lowest = *height, .highest = *height, .summits = {}};
  for (const auto& [dx, dy] : {std::pair{-1, -1}, {-1, 1}, {1, -1}, {1, 1}})
    if (const auto h = ground_(at + Eigen::Vector2d(dx, dy) * options_.step / 2)) {
      place.lowest = std::min(place.lowest, *h);
      place.highest = std::max(place.highest, *h);
    }
  // The eye in the middle of what the ground is here; slack for the rest.
  const double eye = (place.lowest + place.highest) / 2 + options_.eye;
  std::array<double, kSectors> crest;
  crest.fill(-1);
  std::vector<std::pair<std::uint32_t, SummitView>> seen;
  for (std::uint32_t i = 0; i < summits_.size(); ++i) {
    const SummitView v = view_of(summits_[i], at, eye, options_);
    if (v.distance > options_.reach || v.distance < options_.step / 2) continue;
    seen.emplace_back(i, v);
    double& most = crest[static_cast<std::size_t>(sector_of(v.azimuth))];
    most = std::max(most, v.elevation);
  }
  for (const auto& [i, v] : seen) {
    const double near = options_.step / v.distance * std::abs(v.elevation);
    if (v.elevation < crest[static_cast<std::size_t>(sector_of(v.azimuth))] - kBelow - near) continue;
    const Eigen::Vector3d top(summits_[i].at.x(), summits_[i].at.y(), summits_[i].height);
    if (may_clear({at.x(), at.y(), eye}, top, ground_, options_, (place.highest - place.lowest) / 3 + 20))
      place.summits.push_back(i);
  }
  return place;
}

}  // namespace waymark
