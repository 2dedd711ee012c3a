// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "core/units.hpp"
#include "geo/image_source.hpp"
namespace waymark::workflows {

/// Rocks on terrain in a vertical view. All lengths are pixels. Rendered from a height field with many
/// samples per pixel, independently of the detector.
struct RockScene {
  enum class Shape { ellipsoid, irregular, cylinder, mixed };
  std::int64_t columns = 320, rows = 320;
  Degrees incidence{50};   ///< of the sun, from the vertical
  Degrees sun_angle{200};  ///< towards the sun, from x towards y
  Shape shape = Shape::ellipsoid;
  double cover = 0.02;  ///< fraction of the area covered by rocks; rocks do not touch
  double min_diameter = 1.5, max_diameter = 16;
  bool log_uniform = true;  ///< sizes equally likely on a logarithmic scale, else by area n(D) ~ D^-3
  double min_height = 0.3, max_height = 0.7;  ///< height / diameter
  Degrees slope{0};                           ///< of the whole ground
  Degrees downhill{0};                        ///< direction of descent in the image, from x towards y
  double dunes = 0;                           ///< height of dunes, pixels; 0: none
  double dune_length = 14;
  double craters = 0;       ///< fraction of the area inside bowls; 0: none
  double roughness = 0.02;  ///< standard deviation of slopes of the fractal ground
  double albedo = 0.03;     ///< standard deviation of brightness variations
  double skylight = 0.12, haze = 0.05;
  double blur = 0.6;
  double noise = 0.006;  ///< of the sunlit level
  double sunlit = 120;   ///< brightness of level ground in the sun
  bool quantise = true;  ///< whole numbers, as in 8-bit files
  bool lunar = true;     ///< half Lambert, half Lommel-Seeliger; else Lambert
  std::uint64_t seed = 1;
};

struct TrueRockInImage {
  double x = 0, y = 0, diameter = 0;
  double height = 0;  ///< above the ground
  double reach = 0;   ///< height / tan(elevation)
};

struct RockImage {
  Pixels pixels;
  std::vector<TrueRockInImage> rocks;  ///< largest first
};

/// Renders a scene; the same scene gives the same image.
RockImage render(const RockScene& scene);

}  // namespace waymark::workflows
