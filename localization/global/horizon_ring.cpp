// SPDX-License-Identifier: Apache-2.0
#include "localization/global/horizon_ring.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark::localization {

std::vector<HorizonEdge> horizon_ring(const TerrainGrid& ground, const Eigen::Vector2d& at, double eye,
                                      double nearest, int sectors, const SkylineOptions& options) {
  std::vector<HorizonEdge> ring(static_cast<std::size_t>(sectors));
  const double width = 2 * std::numbers::pi / sectors, cell = ground.cell();
  const double bend = curvature_drop(1, options.body_radius, options.refraction);
  const double above = ground.summit() - eye;
  for (int s = 0; s < sectors; ++s) {
    const double azimuth = (s + 0.5) * width, dx = std::cos(azimuth), dy = std::sin(azimuth);
    double best = -1e9, far = 0, block = cell;
    int level = 0;
    const double end = std::min(options.reach, ground.exit_distance(at, {dx, dy}));
    for (double t = std::max(nearest, cell); t < end; t += 0.7 * block) {
      if (above < best * t) break;  // no farther terrain can be higher
      while (2 * block <= t * width && level + 1 < ground.levels()) block *= 2, ++level;
      const float h = ground.highest(at.x() + dx * t, at.y() + dy * t, level);
      if (h == TerrainGrid::kNone) continue;
      const double rise = (double(h) - bend * t * t - eye) / t;
      if (rise > best) best = rise, far = t;
    }
    ring[static_cast<std::size_t>(s)] = {static_cast<float>(best), static_cast<float>(far)};
  }
  return ring;
}

HorizonEdge horizon_at(const TerrainGrid& ground, const Eigen::Vector2d& at, double eye, double azimuth,
                       const SkylineOptions& options) {
  const double dx = std::cos(azimuth), dy = std::sin(azimuth), cell = ground.cell();
  const double bend = curvature_drop(1, options.body_radius, options.refraction);
  const double above = ground.summit() - eye;
  double best = -1e9, far = 0;
  const double end = std::min(options.reach, ground.exit_distance(at, {dx, dy}));
  for (double t = cell; t < end; t += std::max(0.7 * cell, 0.004 * t)) {
    if (above < best * t) break;
    const double rise = (ground.height(at.x() + dx * t, at.y() + dy * t) - bend * t * t - eye) / t;
    if (rise > best) best = rise, far = t;  // false for unknown terrain
  }
  return {static_cast<float>(best), static_cast<float>(far)};
}

}  // namespace waymark::localization
