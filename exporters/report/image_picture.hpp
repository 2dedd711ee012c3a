// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include "core/grid.hpp"
namespace waymark {

/// A part of an image as a JPEG to look at.
struct ImagePicture {
  std::string jpeg;                    ///< bytes of the file
  std::int64_t columns = 0, rows = 0;  ///< of the picture
  Window part;                         ///< of the image, its pixels
};

/// Size of an image file in pixels; nothing where GDAL does not open it.
std::optional<Window> image_extent(const std::string& path);

/// Reads a part of an image so that the picture's longer side has at most `longest` pixels, averaging where
/// it shrinks, and stretches it so that the darkest and the brightest half percent are black and white. Three
/// bands of 8 bit stay in colour. Nothing where the file cannot be read: a picture is a courtesy.
std::optional<ImagePicture> image_picture(const std::string& path, const Window& part, std::int64_t longest);

}  // namespace waymark
