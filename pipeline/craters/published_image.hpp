// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "geo/image_source.hpp"
namespace waymark {

/// The image as another camera and another publisher would give it: by chance blurred, unevenly bright,
/// noisier, striped, flat-fielded, its tones equalised or stretched, pressed by JPEG, resampled. Nothing in
/// it moves. The same for the same seed.
void publish_otherwise(Pixels& image, std::uint64_t seed);

}  // namespace waymark
