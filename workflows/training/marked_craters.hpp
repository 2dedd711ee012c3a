// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "pipeline/craters/shaded_scene.hpp"
namespace waymark::workflows {

/// Reads "IMAGE,TABLE": an image, and the table of all its craters (x, y, diameter in pixels, as `waymark
/// detect craters` writes them; a header is optional).
/// - The direction of the light is that of the image's label, else estimated from its craters.
/// - Throws Error{usage} if no table is named.
/// - Throws Error{input} for craters without a diameter or outside the image, and if no light is found.
pipeline::LabelledScene read_marked_craters(const std::string& image_and_table);

}  // namespace waymark::workflows
