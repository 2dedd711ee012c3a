// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "geo/image_source.hpp"
#include "geo/terrain.hpp"
#include "pipeline/fusion/projection/image_view.hpp"
namespace waymark::pipeline {

struct DemRegistrationRules {
  int fine_radius = 6;     ///< cells of the high-pass filter: window of 2 fine_radius + 1
  int block = 16;          ///< cells; errors of blocks of this side are treated as independent
  double min_blocks = 40;  ///< fewest blocks with known light
  double min_correlation = 0.2;
  double gate = 27.9;  ///< limit of the squared distance from the given pose; 99.99 % of chi-square with 6
                       ///< degrees of freedom
  std::int64_t max_cells = 300'000;  ///< larger areas use coarser cells
  int rounds = 8;
};

/// Registers an image to a DEM by shading: brightness against the light predicted from the DEM's slopes under
/// the image's sun. This constrains the pose error common to all images, which comparisons between images
/// cannot.
/// - Gauss-Newton on the six pose corrections, with the pose covariance as prior.
/// - Brightness at the DEM's cells is explained by light, its square and height (dark dunes), all high-pass
///   filtered.
/// - The score uses the gradients of the prediction, the Hessian those of prediction and image. Structure
///   visible in only one of them neither biases the result nor narrows its covariance.
/// - The covariance is estimated from the scatter of the score between blocks.
/// `std::nullopt` for images without pose, sun or uncertainty, if the correlation is too low, or if the
/// correction exceeds `gate`.
/// `metres_per_unit` of the footprint. Cost: about 0.1 s per megapixel. Errors of the DEM affect all images
/// alike.
std::optional<PoseConstraint> register_to_dem(const Pixels& pixels, const ImageView& image,
                                              const Terrain& terrain, double metres_per_unit,
                                              const DemRegistrationRules& rules = {});

}  // namespace waymark::pipeline
