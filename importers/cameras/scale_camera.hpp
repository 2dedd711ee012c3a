// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "geo/camera.hpp"
namespace waymark::importers {

/// Adapts a camera to the size of an image.
/// - A camera calibrated on the same picture at another size is scaled, with a warning; pixel corners stay
///   pixel corners.
/// - A camera without size takes the image's, and its principal point counts from the middle.
/// Throws Error{input} if the sizes are not in proportion (0.5 % or 1 px), as for another picture or a
/// cropped one.
Camera scale_camera(const Camera& camera, std::int64_t columns, std::int64_t rows, const std::string& path,
                    std::vector<std::string>& warnings);

/// Throws Error{input} for focal lengths of 0 and numbers that are not finite; fx < 0 is a mirrored image.
/// Throws Error{input} for a distortion that does not invert in a quarter of the image or more. Adds a
/// warning if only the corners have no rays.
void check_camera(const Camera& camera, const std::string& file, const std::string& place,
                  std::vector<std::string>& warnings);

}  // namespace waymark::importers
