// SPDX-License-Identifier: Apache-2.0
#include "testbed/landing/relief.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace waymark::testbed {
namespace {

std::uint32_t noise_seed(std::uint64_t seed, std::string_view name) {
  return static_cast<std::uint32_t>(named_seed(seed, name));
}

void add_mountain(Grid<float>& heights, const NodeGrid& nodes, const ReliefModel& relief, Random& random,
                  double x, double y) {
  const double radius = relief.mountain_radius * random.uniform(0.5, 1);
  const double height = relief.mountain_height * random.uniform(0.5, 1);
  const Fractal folds{.longest = radius,
                      .shortest = radius / 20,
                      .amplitude = 0.22,
                      .hurst = 0.8,
                      .seed = static_cast<std::uint32_t>(random.bits())};
  tbb::parallel_for(std::int64_t{0}, nodes.rows, [&](std::int64_t j) {
    for (std::int64_t i = 0; i < nodes.columns; ++i) {
      const double dx = nodes.x(i) - x, dy = nodes.y(j) - y, r = std::hypot(dx, dy) / radius;
      if (r > 1.6) continue;
      const double warped = r + folds.at(dx, dy).value * std::min(1.0, 2 * r);
      const double t = std::clamp(1 - warped / 1.1, 0.0, 1.0);
      heights(i, j) +=
          static_cast<float>(height * t * std::sqrt(t) * (2 - t) * std::clamp(4 * (1.6 - r), 0.0, 1.0));
    }
  });
}

}  // namespace

NodeGrid nodes_of(const SiteModel& ground) {
  const auto count = [&](double length) {
    return static_cast<std::int64_t>(std::llround(length / ground.cell)) + 1;
  };
  NodeGrid nodes{.columns = count(ground.width), .rows = count(ground.height), .step = ground.cell};
  nodes.x0 = ground.east - double(nodes.columns - 1) * ground.cell / 2;
  nodes.y0 = ground.north + double(nodes.rows - 1) * ground.cell / 2;
  return nodes;
}

Fractal relief_fractal(const ReliefModel& relief, double shortest, std::uint64_t seed) {
  Fractal fractal{relief.longest, shortest, 1, relief.hurst, noise_seed(seed, "relief")};
  // The octaves' variances form a geometric series whose sum is rms^2.
  fractal.amplitude = relief.rms * std::sqrt(1 - std::exp2(-2 * relief.hurst));
  return fractal;
}

Grid<float> coarse_relief(const SiteModel& ground, const NodeGrid& nodes, double finest, std::uint64_t seed) {
  const ReliefModel& relief = ground.relief;
  NodeGrid about_middle = nodes;
  about_middle.x0 -= ground.east;
  about_middle.y0 -= ground.north;
  Grid<float> heights = fractal_grid(relief_fractal(relief, finest, seed), about_middle);
  const double azimuth = to_radians(relief.slope_azimuth).value;
  const double fall_x = -relief.slope * std::sin(azimuth), fall_y = -relief.slope * std::cos(azimuth);
  for (std::int64_t j = 0; j < nodes.rows; ++j)
    for (std::int64_t i = 0; i < nodes.columns; ++i)
      heights(i, j) +=
          static_cast<float>(ground.up + fall_x * about_middle.x(i) + fall_y * about_middle.y(j));
  Random random(seed, "mountains");
  for (int m = 0; m < relief.mountains; ++m) {
    const double x = random.uniform(-0.5, 0.5) * ground.width, y = random.uniform(-0.5, 0.5) * ground.height;
    add_mountain(heights, about_middle, relief, random, x, y);
  }
  return heights;
}

Grid<float> add_dunes(Grid<float>& heights, const SiteModel& ground, const NodeGrid& nodes,
                      std::uint64_t seed) {
  const DuneModel& law = ground.dunes;
  Grid<float> cover(nodes.columns, nodes.rows, 0.0F);
  if (!(law.cover > 0) || !(law.height > 0)) return cover;
  NodeGrid about_middle = nodes;
  about_middle.x0 -= ground.east;
  about_middle.y0 -= ground.north;
  const double length = law.wavelength;
  const Grid<float> fields = fractal_grid({.longest = 18 * length,
                                           .shortest = 2 * length,
                                           .amplitude = 1,
                                           .hurst = 0.9,
                                           .seed = noise_seed(seed, "dune fields")},
                                          about_middle);
  std::vector<float> sorted(fields.cells().begin(), fields.cells().end());
  const auto nth =
      static_cast<std::ptrdiff_t>(std::clamp(1 - law.cover, 0.0, 1.0) * double(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + nth, sorted.end());
  const double threshold = double(sorted[std::size_t(nth)]);

  // Crests are a plane wave times a complex random field (phasor noise: Tricard et al. 2019): where the field
  // is zero crests end or fork, as real ones do.
  const std::uint32_t real = noise_seed(seed, "dune crests"), imaginary = noise_seed(seed, "dune forks");
  const Fractal breaks{.longest = 3 * length,
                       .shortest = length / 2,
                       .amplitude = 1,
                       .hurst = 0.5,
                       .seed = noise_seed(seed, "dune breaks")};
  const double azimuth = to_radians(law.wind).value, wx = std::sin(azimuth), wy = std::cos(azimuth);
  tbb::parallel_for(std::int64_t{0}, nodes.rows, [&](std::int64_t j) {
    for (std::int64_t i = 0; i < nodes.columns; ++i) {
      const double inside = std::clamp((double(fields(i, j)) - threshold + 0.15) / 0.3, 0.0, 1.0);
      if (!(inside > 0)) continue;
      const double x = about_middle.x(i), y = about_middle.y(j);
      const double across = (wx * x + wy * y) / length, along = (wx * y - wy * x) / length;
      const double re = gradient_noise(across / 4, along / 9, real).value +
                        0.3 * gradient_noise(across / 2, along / 4, real + 1).value;
      const double im = gradient_noise(across / 4, along / 9, imaginary).value +
                        0.3 * gradient_noise(across / 2, along / 4, imaginary + 1).value;
      const double phase = across + std::atan2(im, re) / (2 * std::numbers::pi);
      const double size =
          std::clamp(0.7 + 0.25 * breaks.at(x * wx + y * wy, 0.35 * (y * wx - x * wy)).value, 0.0, 1.2) *
          std::min(1.0, 1.5 * std::hypot(re, im));
      // Long windward and short lee slope, sharp crests, round troughs.
      const double part = phase - std::floor(phase), rise = part < 0.62 ? part / 0.62 : (1 - part) / 0.38;
      const double ripple_phase = 6.3 * phase + 1.7 * breaks.at(y, x).value;
      const double ripple = 0.04 * std::abs(std::sin(std::numbers::pi * ripple_phase));
      const double shape = rise * std::sqrt(rise) * (1.3 - 0.3 * rise);
      heights(i, j) += static_cast<float>(law.height * inside * (size * shape + ripple));
      cover(i, j) = static_cast<float>(inside * (0.4 + 0.6 * size * shape));
    }
  });
  return cover;
}

Grid<float> paint_albedo(const SiteModel& ground, const NodeGrid& nodes, const Grid<float>& dunes,
                         const Grid<float>& outcrops, const std::vector<CraterPlan>& craters,
                         std::uint64_t seed) {
  const AlbedoModel& law = ground.albedo;
  NodeGrid about_middle = nodes;
  about_middle.x0 -= ground.east;
  about_middle.y0 -= ground.north;
  Grid<float> albedo = fractal_grid({.longest = law.longest,
                                     .shortest = 2 * ground.cell,
                                     .amplitude = law.variation * 0.75,
                                     .hurst = 0.6,
                                     .seed = noise_seed(seed, "albedo")},
                                    about_middle);
  for (const CraterPlan& crater : craters) {
    const double radius = crater.diameter() / 2, freshness = law.rays * std::exp(-crater.age / 0.004);
    if (freshness < 0.01) continue;
    const double reach = 4 * radius;
    const Fractal streaks{.longest = 1, .shortest = 0.2, .amplitude = 0.5, .hurst = 0.5, .seed = crater.seed};
    const auto c0 = std::max<std::int64_t>(0, std::lround(nodes.column(crater.east - reach)));
    const auto c1 = std::min(nodes.columns - 1, std::lround(nodes.column(crater.east + reach)));
    const auto r0 = std::max<std::int64_t>(0, std::lround(nodes.row(crater.north + reach)));
    const auto r1 = std::min(nodes.rows - 1, std::lround(nodes.row(crater.north - reach)));
    for (auto j = r0; j <= r1; ++j)
      for (auto i = c0; i <= c1; ++i) {
        const double dx = nodes.x(i) - crater.east, dy = nodes.y(j) - crater.north,
                     r = std::hypot(dx, dy) / radius;
        if (r > 4) continue;
        const double streak = r > 0.8 ? streaks.at(3 * dx / (r * radius), 3 * dy / (r * radius)).value : 0;
        const double fade = std::exp(-0.9 * std::max(0.0, r - 1)) * std::clamp(4 - r, 0.0, 1.0);
        albedo(i, j) += static_cast<float>(
            freshness * fade * std::clamp(0.7 + std::min(1.0, 2.5 * (r - 0.8)) * streak, 0.0, 1.6));
      }
  }
  const double sand = std::log1p(ground.dunes.brightness), stone = std::log1p(ground.outcrops.brightness);
  for (std::int64_t j = 0; j < nodes.rows; ++j)
    for (std::int64_t i = 0; i < nodes.columns; ++i)
      albedo(i, j) =
          static_cast<float>(law.mean * std::exp(double(albedo(i, j)) + sand * double(dunes(i, j)) +
                                                 stone * double(outcrops(i, j))));
  return albedo;
}

}  // namespace waymark::testbed
