// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "pipeline/craters/shaded_scene.hpp"
namespace waymark::test {
using namespace pipeline;

/// What lies in one square of a made scene.
enum class Place {
  isolated,     ///< one bowl
  doublet,      ///< two craters of like size whose centres are 0.45 to 0.9 diameters apart
  overlapping,  ///< the rim of a younger crater, half to 0.8 as wide, cuts that of an older one
  on_rim,       ///< a crater a quarter to 0.45 as wide is centred on the rim
  nested,       ///< a crater 0.4 to 0.7 as wide lies inside
  flooded,      ///< fresh rim, half to nine tenths of the depth filled
  sand_filled,  ///< fresh rim, nine tenths to all of the depth filled
};
inline constexpr std::array<std::string_view, 7> kPlaces{"isolated", "doublet", "overlapping", "on_rim",
                                                         "nested",   "flooded", "sand_filled"};

/// True crater, and where it lies.
struct PlacedCrater {
  double x = 0, y = 0, diameter = 0;  ///< pixels
  Place place = Place::isolated;
};

/// Made scene with its craters of 16 px and more that kept 0.4 of their depth.
struct PlacedScene {
  Pixels image;
  Radians sun_angle;
  std::vector<PlacedCrater> craters;
};

/// Renders 36 squares of 128 px by the testbed, each with one kind of place. Deterministic for a seed.
PlacedScene placed_scene(std::uint64_t seed);

/// Renders a population of craters drawn by the testbed.
PlacedScene field_scene(std::uint64_t seed);

}  // namespace waymark::test
