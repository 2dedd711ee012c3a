// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/grid.hpp"
#include "core/units.hpp"
namespace waymark::pipeline {

/// Single rock on level ground in a vertical view: half an ellipsoid.
struct SyntheticRock {
  double radius = 2;       ///< radius of its circular outline, pixels
  double reach = 2;        ///< length of level ground in its shadow, pixels: height / tan(elevation)
  Radians elevation{0.7};  ///< of the sun, (0, pi/2)
  Radians sun_angle{0};    ///< towards the sun, from x towards y
  double x = 0, y = 0;     ///< centre of the rock, pixels of the picture
  double blur = 0.6;       ///< standard deviation of the point spread function, pixels
  bool upright = false;    ///< true: cylinder
};

/// Renders the rock as shadow fraction: 1 shadow, 0 ground, below 0 brighter than the ground (Lambert), at
/// least -1.5. Averages over pixels of `columns` x `rows` by supersampling, then blurs.
Grid<float> render_rock_shadow(const SyntheticRock& rock, std::int64_t columns, std::int64_t rows);

}  // namespace waymark::pipeline
