// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
namespace waymark::testbed {

/// Value and slope of gradient noise (Perlin 2002, quintic fade): smooth, mean 0, standard deviation about
/// 1, features about one unit wide. Deterministic for a seed on all machines.
struct NoiseValue {
  double value = 0, dx = 0, dy = 0;
};
NoiseValue gradient_noise(double x, double y, std::uint32_t seed);
double gradient_noise_value(double x, double y, std::uint32_t seed);  ///< the value alone, at half the cost

/// Cosine and sine of the rotation of an octave, which prevents the lattices of octaves from aligning.
struct OctaveTurn {
  double c = 1, s = 0;
};
OctaveTurn octave_turn(std::uint32_t octave);

/// Octaves of gradient noise, from `longest` halved while above `shortest` (metres). The first has standard
/// deviation `amplitude`, each next one 2^-hurst times the previous.
struct Fractal {
  double longest = 100, shortest = 1, amplitude = 1, hurst = 0.85;
  std::uint32_t seed = 0;

  NoiseValue at(double x, double y) const;
};

/// Nodes of a grid: position of the first, which may be anywhere, and spacing, in metres (x right, y up,
/// rows downwards).
struct NodeGrid {
  std::int64_t columns = 0, rows = 0;
  double x0 = 0, y0 = 0, step = 1;

  double x(std::int64_t column) const { return x0 + double(column) * step; }
  double y(std::int64_t row) const { return y0 - double(row) * step; }
  double column(double at_x) const { return (at_x - x0) / step; }
  double row(double at_y) const { return (y0 - at_y) / step; }
};

/// Evaluates the fractal at every node. Long octaves are computed on coarse grids and interpolated
/// cubically (error below 1 % of the octave), so the cost is that of about three octaves.
Grid<float> fractal_grid(const Fractal& fractal, const NodeGrid& nodes);

}  // namespace waymark::testbed
