// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/engine/progress_meter.hpp"
#include "workflows/detection/run_detection.hpp"
namespace waymark::workflows {

/// Carries out a plan for trees. Method `imagery` finds crowns in colour images with a trained network, or as
/// dark green blobs in images finer than 0.25 m without infrared. `peaks` and `lmf` find treetops in a single
/// band of heights above ground. Throws Error{input} for an image in degrees, Error{usage} for a method that
/// does not fit the image's bands.
DetectResult detect_trees(const DetectionPlan& plan, int threads,
                          const pipeline::ProgressMeter::Listener& progress);

}  // namespace waymark::workflows
