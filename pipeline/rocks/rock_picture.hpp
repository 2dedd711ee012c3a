// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/grid.hpp"
#include "core/units.hpp"
namespace waymark {

/// A lonely rock on level ground, seen from straight above: half an ellipsoid.
struct RockPicture {
  double radius = 2;       ///< of its circular outline, pixels
  double reach = 2;        ///< length of level ground its height shades, pixels: height / tan(elevation)
  Radians elevation{0.7};  ///< of the sun, (0, pi/2)
  Radians sun_angle{0};    ///< towards the sun, from x towards y
  double x = 0, y = 0;     ///< middle of the rock, pixels of the picture
  double blur = 0.6;       ///< standard deviation of the point spread, pixels
  bool upright = false;    ///< a cylinder instead
};

/// The rock as shadow fraction: 1 shadow, 0 ground, below 0 brighter than the ground (Lambert), at least
/// -1.5. Averaged over pixels of `columns` x `rows` by supersampling, then blurred.
Grid<float> draw_rock(const RockPicture& rock, std::int64_t columns, std::int64_t rows);

}  // namespace waymark
