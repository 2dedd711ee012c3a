// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <vector>
#include "pipeline/reconstruction/reconstruction.hpp"
namespace waymark::pipeline {

/// Returns the indices of tracks that give each image about `per_image` marks, spread over an 8 x 8 grid,
/// ascending. Long tracks of precise marks come first; a track is taken if any of its images needs it there.
std::vector<std::size_t> thin_tracks(std::span<const TiePoint> tracks, const Reconstruction& images,
                                     std::size_t per_image);

}  // namespace waymark::pipeline
