// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
namespace waymark {

class MapStore;

/// Images with what was found in them, for a person to judge: each whole, and its busiest part at full
/// resolution. What was used is drawn in the colour of its type, what was rejected dashed, with the reason
/// beside the pointer. `most` images, those with the most that was used; the files are looked for where the
/// run read them, and beside the map. Empty where the map has no image with observations.
std::string image_figures(const MapStore& map, std::int64_t most);

}  // namespace waymark
