// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/engine/store/kept_results.hpp"
#include "pipeline/reconstruction/surface/sweep_heights.hpp"
namespace waymark::workflows {

/// Makes a sweep keep the heights of its chunks. They depend on the bytes of the images, poses, lenses and
/// suns, and on the plan. `kept` must outlive the sweep. Nothing changes where nothing is kept.
void keep_chunks(pipeline::SweepPlan& plan, const std::vector<pipeline::SurfaceView>& views,
                 const pipeline::KeptResults& kept);

}  // namespace waymark::workflows
