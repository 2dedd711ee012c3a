// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "pipeline/craters/shaded_scene.hpp"
namespace waymark {

/// A square view, from straight above, of ground that the testbed made and rendered: relief, worn and fresh
/// craters, dunes, rocks and outcrops under a sun 12 to 60 degrees high, pixels of 0.2 to 5 m. Craters that
/// are erased, that show no bowl in the picture, or that the picture cuts, have clarity 0: neither right nor
/// wrong to find. The same for the same seed; about 2 s for 640 pixels.
KnownScene testbed_lesson(std::uint64_t seed, int side);

}  // namespace waymark
