// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/canopy_source.hpp"
#include "geo/image_source.hpp"
namespace waymark {

/// What of an image stands for the canopy.
enum class CanopySign {
  height,     ///< the first band holds heights above ground, metres
  greenness,  ///< excess green times darkness squared
};

/// An image whose pixels are taken for a canopy, so that trees are sought in it as in a height model. With
/// `greenness` the heights are numbers of 0 and more: dark vegetation, as crowns are, has 0.2 to 1. `metres`:
/// size of a pixel. Throws Error{input} where the bands cannot be read.
std::unique_ptr<const CanopySource> image_canopy(const ImageInfo& image, CanopySign sign, double metres);

/// Bands of an image file, a last one of transparency not counted. Throws Error{input}.
int band_count(const std::string& path);

}  // namespace waymark
