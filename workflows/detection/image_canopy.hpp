// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/canopy_source.hpp"
#include "geo/image_source.hpp"
namespace waymark::workflows {

/// Property of an image that stands for canopy height.
enum class CanopySign {
  height,     ///< the first band holds heights above ground, metres
  greenness,  ///< excess green times darkness squared
};

/// Returns a canopy whose heights are an image's pixels, so that trees are found as in a height model.
/// `greenness` gives numbers from 0 up; dark vegetation such as crowns has 0.2 to 1. `metres`: size of a
/// pixel. Throws Error{input} for unreadable bands.
std::unique_ptr<const CanopySource> image_canopy(const ImageInfo& image, CanopySign sign, double metres);

/// Returns the number of bands of an image file without a trailing transparency band. Throws Error{input}.
int band_count(const std::string& path);

}  // namespace waymark::workflows
