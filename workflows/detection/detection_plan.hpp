// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "workflows/detection/image_detector.hpp"
namespace waymark::workflows {

/// A detector with its settings, and what it has to search.
struct PlannedDetection {
  const ImageDetectorSpec& spec;
  ImageDetector detector;
  DetectionPlan plan;
};

/// Throws Error{usage} for options out of range or in conflict, a method or setting of another detector, or
/// an azimuth without a georeference; Error{input} for a missing or damaged image. An image whose
/// georeference cannot be used (degrees, rotated) is searched in pixels, with a warning that names the
/// remedy.
PlannedDetection plan_detection(const DetectRequest& request);

}  // namespace waymark::workflows
