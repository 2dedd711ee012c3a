// SPDX-License-Identifier: Apache-2.0
#include "testbed/noise.hpp"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>

#include "core/random.hpp"

namespace waymark::testbed {
namespace {

// Table of 64 directions, so that lattice points need no trigonometry.
struct Directions {
  std::array<double, 64> x, y;
  Directions() {
    for (std::size_t i = 0; i < 64; ++i) {
      x[i] = std::cos((double(i) + 0.5) * std::numbers::pi / 32);
      y[i] = std::sin((double(i) + 0.5) * std::numbers::pi / 32);
    }
  }
};
const Directions kDirections;

std::uint32_t lattice_hash(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  std::uint32_t h = seed + static_cast<std::uint32_t>(x) * 0x9e3779b1u;
  h = (h ^ (h >> 15)) * 0x85ebca6bu;
  h += static_cast<std::uint32_t>(y) * 0xc2b2ae35u;
  h = (h ^ (h >> 13)) * 0x27d4eb2fu;
  return h ^ (h >> 16);
}

constexpr std::uint32_t kOctaveSeed = 0x51ed270bu;
constexpr double kUnitSpread = 4.66;  // measured: gradient noise itself has a standard deviation of 0.215

Grid<float> upsample_by_two(const Grid<float>& coarse, std::int64_t columns, std::int64_t rows) {
  // Fine node i lies at coarse node 2 + i / 2.
  const auto between = [](float a, float b, float c, float d) { return (9 * (b + c) - a - d) / 16; };
  Grid<float> wide(columns, coarse.rows());
  for (std::int64_t j = 0; j < coarse.rows(); ++j)
    for (std::int64_t i = 0; i < columns; ++i) {
      const std::int64_t c = 2 + i / 2;
      wide(i, j) = i % 2 == 0 ? coarse(c, j)
                              : between(coarse(c - 1, j), coarse(c, j), coarse(c + 1, j), coarse(c + 2, j));
    }
  Grid<float> result(columns, rows);
  tbb::parallel_for(std::int64_t{0}, rows, [&](std::int64_t j) {
    const std::int64_t r = 2 + j / 2;
    for (std::int64_t i = 0; i < columns; ++i)
      result(i, j) =
          j % 2 == 0 ? wide(i, r) : between(wide(i, r - 1), wide(i, r), wide(i, r + 1), wide(i, r + 2));
  });
  return result;
}

}  // namespace

namespace {

// Lattice cell that contains a point, with the projections of its corner offsets on their directions.
struct Lattice {
  double u, v;
  NoiseValue a, b, c, d;  // lower left, lower right, upper left, upper right
  double su, sv;

  Lattice(double x, double y, std::uint32_t seed) {
    const double floor_x = std::floor(x), floor_y = std::floor(y);
    const auto ix = static_cast<std::int32_t>(floor_x), iy = static_cast<std::int32_t>(floor_y);
    u = x - floor_x, v = y - floor_y;
    const auto corner = [&](int right, int up) {
      const std::uint32_t k = lattice_hash(ix + right, iy + up, seed) & 63u;
      const double gx = kDirections.x[k], gy = kDirections.y[k];
      return NoiseValue{gx * (u - right) + gy * (v - up), gx, gy};
    };
    a = corner(0, 0), b = corner(1, 0), c = corner(0, 1), d = corner(1, 1);
    su = u * u * u * (u * (u * 6 - 15) + 10), sv = v * v * v * (v * (v * 6 - 15) + 10);
  }
  double blend(double p, double q, double r, double s) const {
    return p + su * (q - p) + sv * (r - p) + su * sv * (p - q - r + s);
  }
};

}  // namespace

NoiseValue gradient_noise(double x, double y, std::uint32_t seed) {
  const Lattice n(x, y, seed);
  const double du = 30 * n.u * n.u * (n.u - 1) * (n.u - 1), dv = 30 * n.v * n.v * (n.v - 1) * (n.v - 1);
  const double k1 = n.b.value - n.a.value, k2 = n.c.value - n.a.value,
               k3 = n.a.value - n.b.value - n.c.value + n.d.value;
  return {kUnitSpread * n.blend(n.a.value, n.b.value, n.c.value, n.d.value),
          kUnitSpread * (n.blend(n.a.dx, n.b.dx, n.c.dx, n.d.dx) + du * (k1 + k3 * n.sv)),
          kUnitSpread * (n.blend(n.a.dy, n.b.dy, n.c.dy, n.d.dy) + dv * (k2 + k3 * n.su))};
}

double gradient_noise_value(double x, double y, std::uint32_t seed) {
  const Lattice n(x, y, seed);
  return kUnitSpread * n.blend(n.a.value, n.b.value, n.c.value, n.d.value);
}

OctaveTurn octave_turn(std::uint32_t octave) {
  static const auto turns = [] {
    std::array<OctaveTurn, 32> table;
    for (std::size_t i = 0; i < table.size(); ++i)
      table[i] = {std::cos(2.399963 * double(i)), std::sin(2.399963 * double(i))};  // the golden angle
    return table;
  }();
  return turns[octave & 31u];
}

NoiseValue Fractal::at(double x, double y) const {
  NoiseValue sum;
  const double fall = std::exp2(-hurst);
  double height = amplitude, length = longest;
  for (std::uint32_t octave = 0; length > shortest; ++octave, length /= 2, height *= fall) {
    const auto [cos, sin] = octave_turn(octave);
    const double c = cos / length, s = sin / length;
    const NoiseValue n = gradient_noise(c * x - s * y, s * x + c * y, seed + octave * kOctaveSeed);
    sum.value += height * n.value;
    sum.dx += height * (c * n.dx + s * n.dy);
    sum.dy += height * (c * n.dy - s * n.dx);
  }
  return sum;
}

Grid<float> fractal_grid(const Fractal& fractal, const NodeGrid& nodes) {
  constexpr double kEnough = 16;  // nodes per wavelength above which a grid twice as coarse suffices
  Fractal here = fractal;
  Grid<float> result(nodes.columns, nodes.rows, 0.0F);
  if (fractal.longest > kEnough * nodes.step) {
    Fractal coarser = fractal;
    double shortest = fractal.longest;
    std::uint32_t octaves = 0;
    for (; shortest > std::max(fractal.shortest, kEnough * nodes.step); shortest /= 2) ++octaves;
    coarser.shortest = shortest;
    const NodeGrid twice{nodes.columns / 2 + 5, nodes.rows / 2 + 5, nodes.x0 - 4 * nodes.step,
                         nodes.y0 + 4 * nodes.step, 2 * nodes.step};
    result = upsample_by_two(fractal_grid(coarser, twice), nodes.columns, nodes.rows);
    here.longest = shortest;
    here.amplitude *= std::exp2(-fractal.hurst * octaves);
  }
  if (!(here.longest > here.shortest)) return result;
  const auto first = static_cast<std::uint32_t>(std::lround(std::log2(fractal.longest / here.longest)));
  struct Octave {
    double c, s, height;
    std::uint32_t seed;
  };
  std::vector<Octave> octaves;
  for (double height = here.amplitude, length = here.longest; length > here.shortest; length /= 2) {
    const auto octave = first + static_cast<std::uint32_t>(octaves.size());
    const OctaveTurn turn = octave_turn(octave);
    octaves.push_back({turn.c / length, turn.s / length, height, fractal.seed + octave * kOctaveSeed});
    height *= std::exp2(-here.hurst);
  }
  tbb::parallel_for(std::int64_t{0}, nodes.rows, [&](std::int64_t j) {
    const double y = nodes.y(j);
    for (std::int64_t i = 0; i < nodes.columns; ++i) {
      const double x = nodes.x(i);
      double sum = 0;
      for (const Octave& o : octaves)
        sum += o.height * gradient_noise_value(o.c * x - o.s * y, o.s * x + o.c * y, o.seed);
      result(i, j) += static_cast<float>(sum);
    }
  });
  return result;
}

}  // namespace waymark::testbed
