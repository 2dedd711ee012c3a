// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "geo/image_source.hpp"
#include "geo/terrain.hpp"
#include "pipeline/fusion/image_view.hpp"
namespace waymark {

struct GroundMatchRules {
  int fine_radius = 6;       ///< cells: what is coarser than 2 of these + 1 is left out of the comparison
  int block = 16;            ///< cells: errors of blocks of so many are taken as independent
  double least_blocks = 40;  ///< fewer with known light tell nothing
  double least_correlation = 0.2;
  double gate = 27.9;  ///< of the squared distance from the told pose; 99.99 % of a chi-square of 6
  std::int64_t most_cells = 300'000;  ///< coarser cells are made where the image shows more
  int rounds = 8;
};

/// Where an image lies on the ground, by the light on it: brightness against what the DEM's slopes would show
/// under the image's sun. Comparing images with each other cannot tell what their poses are off by together;
/// this can. Gauss-Newton on the six corrections of the pose with its covariance as prior: brightness, seen
/// through the camera at the DEM's cells, against a mean of light, its square and height (dunes are as dark
/// as they are high), all without their coarse part. The score takes the slopes of the prediction and the
/// Hessian those of prediction and image, so that what only one of them shows neither biases nor sharpens the
/// result. Its covariance is told by how the score scatters between blocks.
/// Nothing for images without pose, sun or uncertainty, and where light explains too little of the brightness
/// or the pose would move beyond `gate`. `metres_per_unit` of the footprint.
/// Cost: some 0.1 s for an image of 1 Mpx. All images err alike where the DEM does.
std::optional<PoseTie> match_ground(const Pixels& pixels, const ImageView& image, const Terrain& terrain,
                                    double metres_per_unit, const GroundMatchRules& rules = {});

}  // namespace waymark
