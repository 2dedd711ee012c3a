// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "pipeline/craters/shaded_scene.hpp"
namespace waymark::workflows {

/// Returns a square nadir view that the testbed made and rendered: relief, worn and fresh craters, dunes,
/// rocks and outcrops under a sun 12 to 60 degrees high, pixels of 0.2 to 5 m. Craters that are erased,
/// invisible or cut by the border have clarity 0: detections of them count neither way. Takes about 2 s for
/// 640 pixels.
pipeline::LabelledScene make_testbed_scene(std::uint64_t seed, int side);

}  // namespace waymark::workflows
