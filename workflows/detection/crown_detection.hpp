// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/engine/progress_meter.hpp"
#include "pipeline/forest/canopy_window.hpp"
#include "pipeline/forest/crown_evidence.hpp"
#include "pipeline/vision/dense_network.hpp"
#include "workflows/detection/colour_image.hpp"
namespace waymark::workflows {

inline constexpr double kMaxCrownDiameter = 14;  ///< metres

/// Returns the diameter of the crown centred at `top`, metres, [2 cells, kMaxCrownDiameter]. Rings are
/// followed outwards until dark green (vegetation index times darkness squared, ring mean) falls below half
/// of its central value. `image` covers kMaxCrownDiameter / 2 around. For touching crowns the result is the
/// width of the group.
double crown_width(const pipeline::ColourWindow& image, const pipeline::CanopyCell& top);

/// Returns whether the mean colour of 3 x 3 cells about `top` is that of vegetation, by infrared where the
/// image has it. `image` covers the cell `top`.
bool crown_is_green(const pipeline::ColourWindow& image, const pipeline::CanopyCell& top);

/// A crown in a colour image.
struct DetectedCrown {
  double x = 0, y = 0;    ///< pixels; (0, 0) is the centre of the first
  double diameter = 0;    ///< metres
  double confidence = 0;  ///< calibrated: of detections with 0.7, seven of ten are trees
  bool green = true;      ///< its middle has the colour of vegetation (is_vegetation)
};

/// Returns the crowns of an image in row order: local maxima within 3 m of the probability that a network of
/// pipeline/forest/crown_network gives. `progress` counts pieces of the image. The result does not depend on
/// `threads`.
std::vector<DetectedCrown> detect_crowns(const ColourImage& image, const pipeline::DenseNetwork& network,
                                         int threads, const pipeline::ProgressMeter::Listener& progress = {});

}  // namespace waymark::workflows
