// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "apps/find_in_image.hpp"
namespace waymark {

/// Carries out a plan for trees: method `imagery` seeks crowns in colour images by what a network learnt (in
/// images finer than 0.25 m without infrared: dark green blobs), `peaks` and `lmf` treetops in a single band
/// of heights above ground. Throws Error{input} for an image in degrees, Error{usage} for a method that the
/// image's bands do not serve.
FoundInImage find_trees_in_image(const DetectPlan& plan, int threads,
                                 const ProgressMeter::Listener& progress);

}  // namespace waymark
