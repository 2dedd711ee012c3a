// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "workflows/detection/detection_plan.hpp"
namespace waymark::workflows {

/// Returns a set of detections of `type` in the plan's image that is still empty.
exporters::ImageDetections empty_detections(const DetectionPlan& plan, TypeId type);

/// Checks the brightness of the image, estimates the direction of the light or compares it with the given
/// one, and searches the image. An image in which nothing can be seen (one pixel, black, no data) has no
/// detections and a warning that says why.
DetectResult run_detection(const DetectionPlan& plan, int threads,
                           const pipeline::ProgressMeter::Listener& progress = {});

}  // namespace waymark::workflows
