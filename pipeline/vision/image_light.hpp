// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/units.hpp"
#include "geo/image_source.hpp"
namespace waymark {

/// Direction towards the sun in the image, from x towards y, where it is known: told as such, or the sun's
/// azimuth seen through the camera at the middle of the image (a step on the ground towards the sun), or on
/// an orthophoto. Nothing where the sun is unknown, within half a degree of the zenith, or the middle sees no
/// ground.
std::optional<Radians> image_light(const ImageInfo& image);

}  // namespace waymark
