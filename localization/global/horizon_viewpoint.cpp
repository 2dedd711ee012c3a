// SPDX-License-Identifier: Apache-2.0
#include "localization/global/horizon_viewpoint.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace waymark::localization {
namespace {

constexpr std::size_t kSectors = kHorizonSectors;
constexpr double kWidth = 2 * std::numbers::pi / kHorizonSectors;
constexpr double kModel = 0.004;      // rad: error of cone tracing
constexpr double kMissed = 0.3;       // probability that a top is not on the horizon of the DEM
constexpr double kHiddenSlope = 0.3;  // of terrain in a hole above the filled surface, assumed
constexpr double kAnywhere = 0.2;     // rad: range of elevations at an unknown position

std::optional<HorizonViewpoint> compute_horizons(const TerrainGrid& ground, const Eigen::Vector2d& at,
                                                 double step, const SkylineOptions& options) {
  double sum = 0, squares = 0;
  int known = 0;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) {
      const double h = ground.height(at.x() + i * step / 5, at.y() + j * step / 5);
      if (std::isfinite(h)) sum += h, squares += h * h, ++known;
    }
  if (known == 0) return {};
  const double mean = sum / known;
  HorizonViewpoint viewpoint{.at = at, .step = step, .relief = 0, .ring = {}};
  viewpoint.relief = std::sqrt(std::max(0.0, squares / known - mean * mean));
  viewpoint.ring = horizon_ring(ground, at, mean + options.eye, 0.35 * step, kHorizonSectors, options);
  return viewpoint;
}

struct Tolerance {
  std::array<float, kSectors> inverse, log_density;
};

/// Tolerance of the elevation in each sector for positions within half a step.
Tolerance tolerance(const HorizonViewpoint& viewpoint) {
  Tolerance t;
  const auto& ring = viewpoint.ring;
  for (std::size_t k = 0; k < kSectors; ++k) {
    const double far = std::max(1.0F, ring[k].far), rise = ring[k].rise;
    const double slope = std::clamp(
        (double(ring[(k + 1) % kSectors].rise) - double(ring[(k + kSectors - 1) % kSectors].rise)) /
            (2 * kWidth),
        -0.5, 0.5);
    const double parallax = viewpoint.step / far;
    const double up = viewpoint.relief / far, along = 0.3 * parallax * std::min(std::abs(rise), 2.0),
                 across = 0.3 * slope * std::hypot(kWidth, parallax);
    const double variance = kModel * kModel + up * up + along * along + across * across;
    t.inverse[k] = static_cast<float>(1 / std::sqrt(variance));
    t.log_density[k] =
        static_cast<float>(std::log((1 - kMissed) * kAnywhere / std::sqrt(2 * std::numbers::pi * variance)));
  }
  return t;
}

std::vector<HorizonGuess> headings_at(const HorizonViewpoint& viewpoint, std::span<const HorizonTop> tops,
                                      std::size_t max_count, const SkylineOptions& options) {
  const Tolerance t = tolerance(viewpoint);
  const auto missed = static_cast<float>(std::log(kMissed));
  std::array<float, kSectors> sum{}, one;
  for (const HorizonTop& top : tops) {
    if (!top.elevation) continue;
    const auto rise = static_cast<float>(std::tan(*top.elevation));
    for (std::size_t k = 0; k < kSectors; ++k) {
      const float z = (rise - viewpoint.ring[k].rise) * t.inverse[k];
      one[k] = std::max(missed, t.log_density[k] - z * z / 2);
    }
    const auto turn = static_cast<std::int64_t>(std::floor(top.bearing / kWidth));
    const std::size_t first =
        static_cast<std::size_t>((turn % kHorizonSectors + kHorizonSectors) % kHorizonSectors);
    for (std::size_t y = 0; y < kSectors; ++y) {
      const std::size_t k = (y + first) % kSectors;
      sum[y] += std::max({one[(k + kSectors - 1) % kSectors], one[k], one[(k + 1) % kSectors]});
    }
  }
  std::vector<HorizonGuess> best;
  for (std::size_t y = 0; y < kSectors; ++y) {
    const double yaw = wrap_angle(static_cast<double>(y) * kWidth);
    if (options.heading &&
        std::abs(wrap_angle(yaw - *options.heading)) > options.sigmas * options.heading_sd + kWidth)
      continue;
    if (sum[y] >= sum[(y + 1) % kSectors] && sum[y] > sum[(y + kSectors - 1) % kSectors])
      best.push_back({.at = viewpoint.at, .yaw = yaw, .score = static_cast<double>(sum[y])});
  }
  std::ranges::stable_sort(best, std::greater<>{}, &HorizonGuess::score);
  if (best.size() > max_count) best.resize(max_count);
  return best;
}

}  // namespace

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
  double best = -1e9, far = 0, possible = -1e9;
  const double end = std::min(options.reach, ground.exit_distance(at, {dx, dy}));
  for (double t = cell; t < end; t += std::max(0.7 * cell, 0.004 * t)) {
    if (above < best * t) break;
    const TerrainGrid::Sample surface = ground.surface(at.x() + dx * t, at.y() + dy * t);
    const double rise = (surface.height + kHiddenSlope * surface.gap - bend * t * t - eye) / t;
    if (surface.gap > 0)
      possible = std::max(possible, rise);
    else if (rise > best)  // false where there is no terrain
      best = rise, far = t;
  }
  return {static_cast<float>(best), static_cast<float>(far), static_cast<float>(possible)};
}

std::vector<HorizonViewpoint> compute_horizons(const TerrainGrid& ground, std::span<const Eigen::Vector2d> at,
                                               double step, const SkylineOptions& options) {
  std::vector<std::optional<HorizonViewpoint>> all(at.size());
  tbb::parallel_for(std::size_t{0}, at.size(),
                    [&](std::size_t i) { all[i] = compute_horizons(ground, at[i], step, options); });
  std::vector<HorizonViewpoint> viewpoints;
  for (auto& viewpoint : all)
    if (viewpoint) viewpoints.push_back(std::move(*viewpoint));
  return viewpoints;
}

std::vector<HorizonGuess> best_headings(std::span<const HorizonViewpoint> viewpoints,
                                        std::span<const HorizonTop> tops, std::size_t max_count,
                                        const SkylineOptions& options) {
  std::vector<std::vector<HorizonGuess>> all(viewpoints.size());
  tbb::parallel_for(std::size_t{0}, viewpoints.size(),
                    [&](std::size_t i) { all[i] = headings_at(viewpoints[i], tops, max_count, options); });
  std::vector<HorizonGuess> guesses;
  for (const auto& some : all) guesses.insert(guesses.end(), some.begin(), some.end());
  return guesses;
}

}  // namespace waymark::localization
