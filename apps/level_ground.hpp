// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/engine/pipeline.hpp"
namespace waymark {

/// Images are placed on ground in metres: where a job loads both a DEM and images, its DEM is asked to be
/// metric. A DEM in metres stays as it is.
void ask_for_metres(Pipeline& pipeline);

}  // namespace waymark
