// SPDX-License-Identifier: Apache-2.0
#include "testbed/landing/rock_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "testbed/landing/crater_profile.hpp"
#include "testbed/noise.hpp"

namespace waymark::testbed {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPatch = 6;  // metres, squares in which the density is constant

// N(> D) at `count` diameters from the smallest to the largest, equal steps.
std::vector<double> cumulative_numbers(const RockPopulation& law, std::size_t count) {
  const double q = 1.79 + 0.152 / law.k, step = (law.max_diameter - law.min_diameter) / double(count - 1);
  const auto per_metre = [&](double d) { return law.k * q * std::exp(-q * d) / (kPi * d * d / 4); };
  std::vector<double> numbers(count, 0.0);
  for (std::size_t i = count - 1; i > 0; --i) {
    const double d = law.min_diameter + step * double(i - 1);
    // Simpson's rule on each step: the integrand falls by orders of magnitude over the range.
    numbers[i - 1] =
        numbers[i] + step / 6 * (per_metre(d) + 4 * per_metre(d + step / 2) + per_metre(d + step));
  }
  return numbers;
}

// Rock density of each square relative to the mean.
Grid<double> density_map(const SiteModel& ground, const std::vector<CraterPlan>& craters,
                         std::uint64_t seed) {
  const NodeGrid squares{static_cast<std::int64_t>(std::ceil(ground.width / kPatch)),
                         static_cast<std::int64_t>(std::ceil(ground.height / kPatch)),
                         ground.east - ground.width / 2 + kPatch / 2,
                         ground.north + ground.height / 2 - kPatch / 2, kPatch};
  const Fractal fields{.longest = 150,
                       .shortest = 8,
                       .amplitude = 1,
                       .hurst = 0.6,
                       .seed = static_cast<std::uint32_t>(named_seed(seed, "rock fields"))};
  Grid<double> density(squares.columns, squares.rows);
  for (std::int64_t j = 0; j < squares.rows; ++j)
    for (std::int64_t i = 0; i < squares.columns; ++i) {
      const double x = squares.x(i) - ground.east, y = squares.y(j) - ground.north;
      density(i, j) = std::lerp(1.0, std::exp(1.1 * fields.at(x, y).value), ground.rocks.clustering);
    }
  for (const CraterPlan& crater : craters) {
    const double freshness = std::exp(-crater.age / 0.01) * ground.rocks.on_rims;
    const double radius = crater.diameter() / 2;
    if (freshness < 0.05 || radius < kPatch) continue;
    for (std::int64_t j = 0; j < squares.rows; ++j)
      for (std::int64_t i = 0; i < squares.columns; ++i) {
        const double r = std::hypot(squares.x(i) - crater.east, squares.y(j) - crater.north) / radius;
        if (r < 3.5) density(i, j) += 4 * freshness * std::exp(-2 * (r - 1) * (r - 1));
      }
  }
  const double mean =
      std::accumulate(density.cells().begin(), density.cells().end(), 0.0) / double(density.cells().size());
  for (double& d : density.cells()) d /= mean;
  return density;
}

RockShape draw_shape(const RockPopulation& law, Random& random) {
  const double at = random.uniform(0, law.ellipsoids + law.irregular + law.cylinders);
  if (at < law.ellipsoids) return RockShape::ellipsoid;
  return at < law.ellipsoids + law.irregular ? RockShape::irregular : RockShape::cylinder;
}

}  // namespace

double rocks_per_area(const RockPopulation& law, double diameter) {
  RockPopulation above = law;
  above.min_diameter = diameter;
  return diameter < law.max_diameter ? cumulative_numbers(above, 400).front() : 0;
}

RockField scatter_rocks(const SiteModel& ground, const Terrain& terrain, const Grid<float>& dunes,
                        const std::vector<CraterPlan>& craters, std::uint64_t seed) {
  const RockPopulation& law = ground.rocks;
  if (!(law.k > 0) || !(law.max_diameter > law.min_diameter)) return {};
  const std::vector<double> numbers = cumulative_numbers(law, 400);
  const double step = (law.max_diameter - law.min_diameter) / double(numbers.size() - 1);
  const Grid<double> density = density_map(ground, craters, seed);

  struct Seed {
    double x, y, width;
    std::uint64_t seed;
  };
  std::vector<Seed> seeds;
  Random random(seed, "rocks");
  for (std::int64_t j = 0; j < density.rows(); ++j)
    for (std::int64_t i = 0; i < density.columns(); ++i) {
      const auto count = random.poisson(density(i, j) * numbers.front() * kPatch * kPatch);
      for (std::uint64_t k = 0; k < count; ++k) {
        const double x = ground.east - ground.width / 2 + (double(i) + random.uniform()) * kPatch;
        const double y = ground.north + ground.height / 2 - (double(j) + random.uniform()) * kPatch;
        const double wanted = random.uniform() * numbers.front();
        const auto after = std::lower_bound(numbers.begin(), numbers.end(), wanted, std::greater<>());
        const auto m = std::clamp<std::ptrdiff_t>(after - numbers.begin(), 1, std::ssize(numbers) - 1);
        const double from = numbers[std::size_t(m)], to = numbers[std::size_t(m - 1)];
        const double part = to > from ? (wanted - from) / (to - from) : 0;
        seeds.push_back({x, y, law.min_diameter + step * (double(m) - part), random.bits()});
      }
    }
  std::stable_sort(seeds.begin(), seeds.end(),
                   [](const Seed& a, const Seed& b) { return a.width > b.width; });

  // Squares as wide as the widest rock: a rock can only overlap those of the nine squares about its own.
  const double square = law.max_diameter * 1.3;
  Grid<std::vector<std::uint32_t>> taken(static_cast<std::int64_t>(ground.width / square) + 3,
                                         static_cast<std::int64_t>(ground.height / square) + 3);
  RockField field;
  for (const Seed& s : seeds) {
    const auto ground_height = terrain.height(s.x, s.y);
    if (!ground_height) continue;
    const auto column = static_cast<std::int64_t>((s.x - terrain.x0()) / terrain.step_x());
    const auto row = static_cast<std::int64_t>((terrain.y0() - s.y) / terrain.step_y());
    if (Random(s.seed, "buried").bernoulli(0.9 * double(dunes(column, row)))) continue;
    const auto c = static_cast<std::int64_t>((s.x - ground.east + ground.width / 2) / square) + 1;
    const auto r = static_cast<std::int64_t>((ground.north + ground.height / 2 - s.y) / square) + 1;
    bool free = c + 1 < taken.columns() && r + 1 < taken.rows();
    for (std::int64_t dr = -1; dr <= 1 && free; ++dr)
      for (std::int64_t dc = -1; dc <= 1 && free; ++dc)
        for (const std::uint32_t other : taken(c + dc, r + dr)) {
          const TrueRock& rock = field.rocks[other];
          const double apart = std::hypot(rock.position.x() - s.x, rock.position.y() - s.y);
          free = free && apart > 0.55 * (rock.width + s.width);
        }
    if (!free) continue;
    Random own(s.seed);
    const RockShape shape = draw_shape(law, own);
    const double height = s.width * std::clamp(own.normal(0.5, 0.12), 0.25, 0.85);
    RockSolid solid = make_rock(shape, s.width, height, own);
    solid.foot = {s.x, s.y, *ground_height};
    taken(c, r).push_back(static_cast<std::uint32_t>(field.rocks.size()));
    field.rocks.push_back({solid.foot, s.width, height, shape});
    field.solids.push_back(std::move(solid));
  }
  return field;
}

}  // namespace waymark::testbed
