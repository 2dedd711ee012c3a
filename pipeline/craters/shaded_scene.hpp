// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
#include "core/units.hpp"
#include "geo/image_source.hpp"
namespace waymark {

/// A crater whose place in an image is known.
struct KnownCrater {
  double x = 0, y = 0;  ///< centre of the rim crest, pixels
  double diameter = 0;  ///< of the rim crest, pixels
  double clarity = 1;   ///< how much of the relief about it is its own, [0, 1]: below 0.5 people disagree
};

/// An image with known craters, to train on.
struct KnownScene {
  Pixels image;
  Radians sun_angle;  ///< towards the sun, from x towards y
  std::vector<KnownCrater> craters;
};

/// A square piece of made-up planet under a low or high sun, as different from one seed to the next as images
/// of the Moon and Mars are: fractal ground, valleys, ridges, hills, hollows that are no craters, ripples;
/// craters by a power law, from fresh to almost gone, filled, elliptic, overlapping; Lambert shading, cast
/// shadows, albedo, blur, noise, and the hard contrast stretch of published images. Heights are in pixels.
/// The sun stands at one of the four sides of the image. The same for the same seed everywhere; about 1 s for
/// 768 pixels.
KnownScene shaded_scene(std::uint64_t seed, int side = 768);

}  // namespace waymark
