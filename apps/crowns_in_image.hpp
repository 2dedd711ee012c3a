// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "apps/colour_image.hpp"
#include "pipeline/engine/progress_meter.hpp"
#include "pipeline/vision/dense_network.hpp"
namespace waymark {

/// A crown in a colour image.
struct CrownInImage {
  double x = 0, y = 0;    ///< pixels; (0, 0) is the centre of the first
  double diameter = 0;    ///< metres
  double confidence = 0;  ///< calibrated: of finds with 0.7, seven of ten are trees
};

/// The crowns of an image, by a network of pipeline/forest/crown_network: local maxima of the probability
/// within 3 m. In row order; `progress` is told how many pieces are done; the same for any `threads`.
std::vector<CrownInImage> crowns_in_image(const ColourImage& image, const DenseNetwork& network, int threads,
                                          const ProgressMeter::Listener& progress = {});

}  // namespace waymark
