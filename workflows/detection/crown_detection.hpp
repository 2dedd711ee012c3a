// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/engine/progress_meter.hpp"
#include "pipeline/vision/dense_network.hpp"
#include "workflows/detection/colour_image.hpp"
namespace waymark::workflows {

/// A crown in a colour image.
struct DetectedCrown {
  double x = 0, y = 0;    ///< pixels; (0, 0) is the centre of the first
  double diameter = 0;    ///< metres
  double confidence = 0;  ///< calibrated: of detections with 0.7, seven of ten are trees
};

/// Returns the crowns of an image in row order: local maxima within 3 m of the probability that a network of
/// pipeline/forest/crown_network gives. `progress` counts pieces of the image. The result does not depend on
/// `threads`.
std::vector<DetectedCrown> detect_crowns(const ColourImage& image, const pipeline::DenseNetwork& network,
                                         int threads, const pipeline::ProgressMeter::Listener& progress = {});

}  // namespace waymark::workflows
