// SPDX-License-Identifier: Apache-2.0
#include "testbed/town/town.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "core/units.hpp"

namespace waymark::testbed {
namespace {

constexpr double kMinTurn = 30 * kRadiansPerDegree;
constexpr double kPathStep = 0.5;  // m

double cross_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

std::string cell_of(const std::optional<double>& value) {
  return value ? fmt::format("{:.4f}", *value) : "";
}

/// Angles are cut to four decimals, which rounding would lift over the end of their range.
std::string angle_cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.4f}", std::trunc(*value * 1e4) / 1e4) : "";
}

}  // namespace

Eigen::Vector2d TownPost::at_time(double t) const {
  const double length = (to - at).norm();
  if (!(speed > 0 && length > 0)) return at;
  const double phase = std::fmod(t * speed / length, 2.0);
  return at + (phase < 1 ? phase : 2 - phase) * (to - at);
}

std::optional<TownHit> Town::hit(const Eigen::Vector2d& from, const Eigen::Vector2d& along, double t) const {
  constexpr double kLineScanner = 0.5;  // m above the road: below the plates of signs, above kerbs
  TownHit nearest{.range = std::numeric_limits<double>::infinity()};
  visit_hits(from, along, t, [&](const TownHit& hit) {
    if (hit.range < nearest.range && hit.bottom <= kLineScanner && hit.top >= kLineScanner) nearest = hit;
  });
  return nearest.surface ? std::optional(nearest) : std::nullopt;
}

std::optional<double> Town::cast(const Eigen::Vector2d& from, const Eigen::Vector2d& along, double t) const {
  const auto first = hit(from, along, t);
  return first ? std::optional(first->range) : std::nullopt;
}

void add_outline(Town& town, const std::vector<Eigen::Vector2d>& outline, bool from_inside) {
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d &at = outline[i], &next = outline[(i + 1) % n], &last = outline[(i + n - 1) % n];
    town.walls.push_back({at, next});
    const Eigen::Vector2d a = (at - last).normalized(), b = (next - at).normalized();
    const double turn = std::atan2(cross_of(a, b), a.dot(b)), side = from_inside ? -1 : 1;
    if (std::abs(turn) < kMinTurn) continue;
    const Eigen::Vector2d mean = a + b, open = side * Eigen::Vector2d(mean.y(), -mean.x());
    town.landmarks.push_back({.type = "wall_corner",
                              .kind = {},
                              .at = at,
                              .direction = std::atan2(open.x(), open.y()),
                              .opening_angle = std::numbers::pi + side * turn});
  }
}

std::vector<Eigen::Vector2d> dense_path(const std::vector<Eigen::Vector2d>& waypoints) {
  std::vector<Eigen::Vector2d> path;
  for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) {
    const Eigen::Vector2d run = waypoints[i + 1] - waypoints[i];
    const double pieces = std::max(1.0, std::round(run.norm() / kPathStep));
    for (double k = 0; k < pieces; ++k) path.push_back(waypoints[i] + k / pieces * run);
  }
  path.push_back(waypoints.back());
  return path;
}

std::string town_table(const Town& town) {
  std::string text =
      "type,uid,kind,x,y,z,direction,opening_angle,side,orientation,facing,diameter,height,width,length\n";
  std::map<std::string, int> count;
  for (const TownLandmark& l : town.landmarks)
    text += fmt::format("{},{}{},{},{:.4f},{:.4f},0,{},{},{},{},{},{},{},{},{}\n", l.type, l.type,
                        ++count[l.type], l.kind, l.at.x(), l.at.y(), angle_cell(l.direction),
                        cell_of(l.opening_angle), cell_of(l.side), angle_cell(l.orientation),
                        angle_cell(l.facing), cell_of(l.diameter), cell_of(l.height), cell_of(l.width),
                        cell_of(l.length));
  return text;
}

}  // namespace waymark::testbed
