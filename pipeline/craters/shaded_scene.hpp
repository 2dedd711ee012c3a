// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
#include "core/units.hpp"
#include "geo/image_source.hpp"
namespace waymark::pipeline {

/// Crater with a known position in an image.
struct LabelledCrater {
  double x = 0, y = 0;  ///< centre of the rim crest, pixels
  double diameter = 0;  ///< of the rim crest, pixels
  double clarity =
      1;  ///< fraction of the surrounding relief that is its own, [0, 1]; below 0.5 annotators disagree
};

/// Training image with known craters.
struct LabelledScene {
  Pixels image;
  Radians sun_angle;  ///< towards the sun, from x towards y
  std::vector<LabelledCrater> craters;
};

/// Returns a square synthetic image of cratered terrain; seeds vary as much as images of the Moon and Mars
/// do.
/// - Relief: fractal terrain, valleys, ridges, hills, hollows that are no craters, ripples. Heights are in
///   pixels.
/// - Craters: power-law sizes, from fresh to almost erased, infilled, elliptic, overlapping.
/// - Image: Lambert shading, cast shadows, albedo, blur, noise and the hard contrast stretch of published
///   images. The sun is at one of the four sides.
/// Deterministic for a seed on all machines; about 1 s for 768 pixels.
LabelledScene shaded_scene(std::uint64_t seed, int side = 768);

}  // namespace waymark::pipeline
