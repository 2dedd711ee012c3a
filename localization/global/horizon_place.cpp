// SPDX-License-Identifier: Apache-2.0
#include "localization/global/horizon_place.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace waymark {
namespace {

constexpr std::size_t kSectors = kHorizonSectors;
constexpr double kWidth = 2 * std::numbers::pi / kHorizonSectors;
constexpr double kModel = 0.004;   // rad: what cone tracing is off by
constexpr double kMissed = 0.3;    // probability that a top is not on the horizon as the DEM has it
constexpr double kAnywhere = 0.2;  // rad: the band elevations lie in at a place of which nothing is known

std::optional<HorizonPlace> look_round(const TerrainGrid& ground, const Eigen::Vector2d& at, double step,
                                       const SkylineOptions& options) {
  double sum = 0, squares = 0;
  int known = 0;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) {
      const double h = ground.height(at.x() + i * step / 5, at.y() + j * step / 5);
      if (std::isfinite(h)) sum += h, squares += h * h, ++known;
    }
  if (known == 0) return {};
  const double mean = sum / known;
  HorizonPlace place{.at = at, .step = step, .relief = 0, .ring = {}};
  place.relief = std::sqrt(std::max(0.0, squares / known - mean * mean));
  place.ring = horizon_ring(ground, at, mean + options.eye, 0.35 * step, kHorizonSectors, options);
  return place;
}

struct Tolerance {
  std::array<float, kSectors> inverse, log_density;
};

/// Of the elevation in each sector for whoever stands anywhere within half a step.
Tolerance tolerance(const HorizonPlace& place) {
  Tolerance t;
  const auto& ring = place.ring;
  for (std::size_t k = 0; k < kSectors; ++k) {
    const double far = std::max(1.0F, ring[k].far), rise = ring[k].rise;
    const double slope = std::clamp(
        (double(ring[(k + 1) % kSectors].rise) - double(ring[(k + kSectors - 1) % kSectors].rise)) /
            (2 * kWidth),
        -0.5, 0.5);
    const double parallax = place.step / far;
    const double up = place.relief / far, along = 0.3 * parallax * std::min(std::abs(rise), 2.0),
                 across = 0.3 * slope * std::hypot(kWidth, parallax);
    const double variance = kModel * kModel + up * up + along * along + across * across;
    t.inverse[k] = static_cast<float>(1 / std::sqrt(variance));
    t.log_density[k] =
        static_cast<float>(std::log((1 - kMissed) * kAnywhere / std::sqrt(2 * std::numbers::pi * variance)));
  }
  return t;
}

std::vector<HorizonGuess> headings_at(const HorizonPlace& place, std::span<const HorizonTop> tops,
                                      std::size_t most, const SkylineOptions& options) {
  const Tolerance t = tolerance(place);
  const auto missed = static_cast<float>(std::log(kMissed));
  std::array<float, kSectors> sum{}, one;
  for (const HorizonTop& top : tops) {
    if (!top.elevation) continue;
    const auto rise = static_cast<float>(std::tan(*top.elevation));
    for (std::size_t k = 0; k < kSectors; ++k) {
      const float z = (rise - place.ring[k].rise) * t.inverse[k];
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
    const double yaw = wrapped(static_cast<double>(y) * kWidth);
    if (options.heading &&
        std::abs(wrapped(yaw - *options.heading)) > options.sigmas * options.heading_sd + kWidth)
      continue;
    if (sum[y] >= sum[(y + 1) % kSectors] && sum[y] > sum[(y + kSectors - 1) % kSectors])
      best.push_back({.at = place.at, .yaw = yaw, .score = static_cast<double>(sum[y])});
  }
  std::ranges::stable_sort(best, std::greater<>{}, &HorizonGuess::score);
  if (best.size() > most) best.resize(most);
  return best;
}

}  // namespace

std::vector<HorizonPlace> look_round(const TerrainGrid& ground, std::span<const Eigen::Vector2d> at,
                                     double step, const SkylineOptions& options) {
  std::vector<std::optional<HorizonPlace>> all(at.size());
  tbb::parallel_for(std::size_t{0}, at.size(),
                    [&](std::size_t i) { all[i] = look_round(ground, at[i], step, options); });
  std::vector<HorizonPlace> places;
  for (auto& place : all)
    if (place) places.push_back(std::move(*place));
  return places;
}

std::vector<HorizonGuess> best_headings(std::span<const HorizonPlace> places,
                                        std::span<const HorizonTop> tops, std::size_t most,
                                        const SkylineOptions& options) {
  std::vector<std::vector<HorizonGuess>> all(places.size());
  tbb::parallel_for(std::size_t{0}, places.size(),
                    [&](std::size_t i) { all[i] = headings_at(places[i], tops, most, options); });
  std::vector<HorizonGuess> guesses;
  for (const auto& some : all) guesses.insert(guesses.end(), some.begin(), some.end());
  return guesses;
}

}  // namespace waymark
