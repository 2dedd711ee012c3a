// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/units.hpp"
#include "geo/image_source.hpp"
namespace waymark::pipeline {

/// Returns the direction towards the sun in the image, from x towards y.
/// - The given image angle, if there is one.
/// - Else the azimuth of the sun, projected through the camera at the image centre or onto the orthophoto.
/// `std::nullopt` if the sun is unknown or within half a degree of the zenith, or if the image centre
/// misses the ground.
std::optional<Radians> sun_angle_in_image(const ImageInfo& image);

}  // namespace waymark::pipeline
