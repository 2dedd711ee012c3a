// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "apps/detect_request.hpp"
#include "exporters/detections.hpp"
#include "pipeline/engine/progress_meter.hpp"
namespace waymark {

struct FoundInImage {
  ImageDetections detections;
  std::string light;  ///< where the light comes from, if that was estimated; empty: it was told
  std::vector<std::string> warnings;
};

/// The detections of a type in the plan's image, none yet.
ImageDetections none_yet(const DetectPlan& plan, TypeId type);

/// Carries a plan out: looks at the brightness of the image, estimates the direction of the light where it is
/// not told, checks it where it is, and searches the image. An image in which nothing can be seen (one pixel,
/// black, no data) has no detections and a warning that says why. `progress` is told of the search.
FoundInImage find_in_image(const DetectPlan& plan, int threads, const ProgressMeter::Listener& progress = {});

}  // namespace waymark
