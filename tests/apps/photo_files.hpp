// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>
namespace waymark::test {

/// Grey picture in memory.
struct GreyPicture {
  int columns = 0, rows = 0;
  std::vector<unsigned char> grey = {};
};

/// Position and orientation that a camera writes into a picture.
struct PhotoExif {
  std::optional<double> lon = {}, lat = {}, altitude = {};
  int orientation = 1;
};

GreyPicture read_picture(const std::filesystem::path& file);
/// Writes a JPEG file with EXIF.
void write_photo(const std::filesystem::path& file, const GreyPicture& picture, const PhotoExif& exif = {});

GreyPicture mirrored_picture(const GreyPicture& picture);
/// Means of 2 x 2 pixels.
GreyPicture halved_picture(const GreyPicture& picture);
GreyPicture uniform_picture(int columns, int rows, unsigned char grey);
/// Random blocks of 4 x 4 pixels: full of corners, and unlike those of another seed.
GreyPicture noise_picture(int columns, int rows, unsigned seed);

}  // namespace waymark::test
