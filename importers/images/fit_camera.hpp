// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "geo/camera.hpp"
namespace waymark {

/// The camera for an image of this size. One that was calibrated on the same picture at another size is
/// scaled (pixel corners stay pixel corners), with a warning; one that states no size takes the image's, and
/// its principal point counts from the middle. Throws Error{input} where the sizes are not in proportion (0.5
/// % or 1 px): another picture, or a cropped one.
Camera fit_camera(const Camera& camera, std::int64_t columns, std::int64_t rows, const std::string& path,
                  std::vector<std::string>& warnings);

/// Throws Error{input} for focal lengths of 0 (fx < 0: a mirrored image), numbers that are not finite, a
/// distortion that does not invert in a quarter of the image or more. Adds a warning where only the corners
/// have no rays.
void check_camera(const Camera& camera, const std::string& file, const std::string& place,
                  std::vector<std::string>& warnings);

}  // namespace waymark
