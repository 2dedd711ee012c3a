// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include "core/grid.hpp"
#include "exporters/report/relief_picture.hpp"
namespace waymark::exporters {

/// A part of an image as a JPEG for display.
struct ImagePicture {
  std::string jpeg;                    ///< bytes of the file
  std::int64_t columns = 0, rows = 0;  ///< of the picture
  Window part;                         ///< of the image, its pixels
};

/// Returns the size of an image file in pixels; `std::nullopt` if GDAL cannot open it.
std::optional<Window> image_extent(const std::string& path);

/// Reads a part of an image and averages it so that the longer side has at most `longest` pixels. Stretches
/// the contrast: the darkest and the brightest half percent become black and white. Three bands of 8 bit stay
/// in colour; alpha is 0 for no data. `std::nullopt` if the file cannot be read, since pictures are optional.
std::optional<Grid<Colour>> image_pixels(const std::string& path, const Window& part, std::int64_t longest);

/// Returns image_pixels() as a JPEG.
std::optional<ImagePicture> image_picture(const std::string& path, const Window& part, std::int64_t longest);

}  // namespace waymark::exporters
