// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "geo/image_source.hpp"
#include "importers/cameras/camera_set.hpp"
namespace waymark::importers {

/// Options that select images and supply their metadata.
struct ImageListing {
  std::vector<std::string> files = {};  ///< images, patterns, or folders: every image in them
  std::string cameras = {};             ///< a camera file, or a pattern for several of one format
  std::string format = {};              ///< of the camera files; empty: recognised from the contents
  CameraImport import = {};             ///< `crs` also applies to orthophotos

  enum class SunFrom { all, time, nothing };
  SunFrom sun_from = SunFrom::all;
  std::optional<Sun> sun = {};  ///< of every image, overriding all other sources
  std::optional<Degrees> image_sun_angle = {};
  std::string time_zone = {};  ///< of EXIF times without offset: "+08:00"
  std::optional<Meters> gsd = {};
  double saturated = 0;
  std::int64_t band = 0;
};

struct ListedImages {
  std::vector<ImageInfo> images;  ///< sorted by name; a missing or damaged file has 0 columns
  std::vector<std::string> warnings;
};

/// Opens the header of every image and combines file, camera, sun and time.
/// - A fault of one image is a warning, not an error: its own work fails and the rest continues.
/// - Images that a camera file names and `files` lacks are listed as missing, unless `files` names single
///   images only.
/// - The sun is the first that is known of: `sun`; the camera file; the label (an orthophoto: as azimuth;
///   else as image angle); time and position on Earth.
/// Throws Error if there are no images or a camera file cannot be read.
ListedImages list_images(const ImageListing& listing);

}  // namespace waymark::importers
