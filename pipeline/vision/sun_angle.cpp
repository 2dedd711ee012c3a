// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/sun_angle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pipeline/vision/local_background.hpp"
namespace waymark::pipeline {
namespace {

constexpr double kPi = std::numbers::pi;

// Direction from a dark spot to its bright side, and its weight.
struct Pair {
  double angle = 0;  // from the dark towards the bright, from x towards y
  double weight = 0;
};

// Brightness above the local ground, in its standard deviations.
Grid<float> excess_brightness(const Pixels& image, int tile) {
  const LocalBackground ground = local_background(image, tile);
  const float min_spread = std::max(noise_sd(image), 1e-6F);
  Grid<float> excess(image.columns(), image.rows());
  std::vector<float> level(static_cast<std::size_t>(image.columns())), spread(level.size());
  for (std::int64_t y = 0; y < image.rows(); ++y) {
    ground.read_row(y, level, spread);
    const auto in = image.row(y);
    const auto out = excess.row(y);
    for (std::size_t x = 0; x < level.size(); ++x) {
      const float e = (in[x] - level[x]) / std::max(min_spread, spread[x]);
      out[x] = std::isfinite(e) ? e : 0;
    }
  }
  return excess;
}

float smooth_at(const Grid<float>& g, std::int64_t x, std::int64_t y) {
  return 0.25F * g(x, y) + 0.125F * (g(x - 1, y) + g(x + 1, y) + g(x, y - 1) + g(x, y + 1)) +
         0.0625F * (g(x - 1, y - 1) + g(x + 1, y - 1) + g(x - 1, y + 1) + g(x + 1, y + 1));
}

// Returns half the diameter of the dark spot: the distance over which its darkness exceeds a third, averaged
// over eight directions.
double dark_radius(const Grid<float>& excess, std::int64_t x, std::int64_t y, float floor, int max_step) {
  static constexpr int kX[] = {1, 1, 0, -1, -1, -1, 0, 1}, kY[] = {0, 1, 1, 1, 0, -1, -1, -1};
  double sum = 0;
  for (int d = 0; d < 8; ++d) {
    int step = 1;
    while (step <= max_step && excess.contains(x + step * kX[d], y + step * kY[d]) &&
           excess(x + step * kX[d], y + step * kY[d]) < floor / 3)
      ++step;
    if (step > max_step) return max_step + 1.0;
    sum += step * std::hypot(kX[d], kY[d]);
  }
  return sum / 8;
}

// First moment of brightness in a disc three times as wide as the spot.
Pair pair_at(const Grid<float>& excess, std::int64_t x, std::int64_t y, double half, float floor) {
  const auto disc = static_cast<std::int64_t>(std::ceil(2.2 * half + 1.5));
  double mx = 0, my = 0, bright = 0;
  const auto cap = static_cast<double>(-floor);
  for (std::int64_t dy = -disc; dy <= disc; ++dy)
    for (std::int64_t dx = -disc; dx <= disc; ++dx) {
      if (!excess.contains(x + dx, y + dy)) return {};
      const double d = std::hypot(static_cast<double>(dx), static_cast<double>(dy));
      if (d < 0.5 || d > static_cast<double>(disc)) continue;
      const double e = std::clamp(static_cast<double>(excess(x + dx, y + dy)), 0.0, cap);
      mx += e * static_cast<double>(dx) / d;
      my += e * static_cast<double>(dy) / d;
      bright += e;
    }
  const double moment = std::hypot(mx, my);
  if (!(bright > 0)) return {};
  // Fraction of the light on one side, and amount of light relative to the darkness.
  const double one_sided = moment / bright, amount = std::min(1.0, moment / (cap * std::max(1.0, half)));
  return {std::atan2(my, mx), one_sided * one_sided * amount};
}

}  // namespace

std::optional<SunAngle> estimate_sun_angle(const Pixels& image, int max_extent) {
  if (image.columns() < 16 || image.rows() < 16) return std::nullopt;
  const Grid<float> excess = excess_brightness(image, std::max(16, 2 * max_extent));
  std::vector<Pair> pairs;
  for (std::int64_t y = 2; y + 2 < image.rows(); ++y)
    for (std::int64_t x = 2; x + 2 < image.columns(); ++x) {
      if (excess(x, y) > -3.0F) continue;
      const float here = smooth_at(excess, x, y);
      if (here > -3.0F) continue;
      bool darkest = true;
      for (std::int64_t dy = -1; dy <= 1 && darkest; ++dy)
        for (std::int64_t dx = -1; dx <= 1 && darkest; ++dx)
          if (dx != 0 || dy != 0) {
            const float other = smooth_at(excess, x + dx, y + dy);
            darkest = here < other || (here == other && (dy > 0 || (dy == 0 && dx > 0)));
          }
      if (!darkest) continue;
      const double half = dark_radius(excess, x, y, here, max_extent / 2);
      if (half > max_extent / 2.0) continue;
      Pair pair = pair_at(excess, x, y, half, here);
      pair.weight *= std::min(12.0F, -here) / 12;  // limits the weight of very clear spots
      if (pair.weight > 0.01) pairs.push_back(pair);
    }
  if (pairs.size() < 4) return std::nullopt;
  // Mode of the directions with a kernel of 0.4 rad, refined by a weighted mean.
  double centre = 0, best = -1;
  for (int k = 0; k < 72; ++k) {
    const double angle = k * kPi / 36 - kPi;
    double sum = 0;
    for (const Pair& pair : pairs) {
      const double d = std::remainder(pair.angle - angle, 2 * kPi) / 0.4;
      sum += pair.weight * std::exp(-0.5 * d * d);
    }
    if (sum > best) {
      best = sum;
      centre = angle;
    }
  }
  double spread = 0.5, total = 0, squares = 0, agreeing = 0;
  int count = 0;
  for (int round = 0; round < 12; ++round) {
    double sum = 0, moment = 0;
    total = squares = agreeing = 0;
    count = 0;
    for (const Pair& pair : pairs) {
      const double d = std::remainder(pair.angle - centre, 2 * kPi);
      total += pair.weight;
      if (std::abs(d) > 0.8) continue;
      const double w = pair.weight / (1 + d * d / 0.09);
      sum += w;
      moment += w * d;
      squares += w * w * d * d;
      agreeing += pair.weight;
      ++count;
    }
    if (!(sum > 0)) return std::nullopt;
    centre = std::remainder(centre + moment / sum, 2 * kPi);
    spread = std::sqrt(squares) / sum;
  }
  // By chance a quarter of the pairs would fall into 0.8 rad either side.
  const double chance = 1.6 / (2 * kPi), fraction = agreeing / total;
  const double deviation = std::sqrt(chance * (1 - chance) / static_cast<double>(pairs.size()));
  if (count < 4 || fraction < chance + std::max(0.12, 4 * deviation)) return std::nullopt;
  return SunAngle{{centre}, {std::hypot(spread, 0.02) * (fraction > 0.6 ? 1.0 : 2.0)}, count};
}

}  // namespace waymark::pipeline
