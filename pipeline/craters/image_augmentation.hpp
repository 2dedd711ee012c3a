// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "geo/image_source.hpp"
namespace waymark::pipeline {

/// Applies random radiometric changes: blur, uneven brightness, noise, stripes, flat-fielding, equalisation
/// or stretch, JPEG compression, resampling. Positions do not change. Deterministic for a seed.
void augment_image(Pixels& image, std::uint64_t seed);

}  // namespace waymark::pipeline
