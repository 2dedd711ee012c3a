// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "geo/image_source.hpp"
#include "importers/images/camera_set.hpp"
namespace waymark {

/// Which images there are and what is known of them.
struct ImageListing {
  std::vector<std::string> files = {};  ///< images, patterns, or folders: every image in them
  std::string cameras = {};             ///< a camera file, or a pattern for several of one format
  std::string format = {};              ///< of the camera files; empty: recognised
  CameraImport import = {};             ///< `crs` is of orthophotos too

  enum class SunFrom { all, time, nothing };
  SunFrom sun_from = SunFrom::all;
  std::optional<Sun> sun = {};  ///< of every image, whatever else is known
  std::optional<Degrees> image_sun_angle = {};
  std::string time_zone = {};  ///< of EXIF times without offset: "+08:00"
  std::optional<Meters> gsd = {};
  double saturated = 0;
  int band = 0;
};

struct ListedImages {
  std::vector<ImageInfo> images;  ///< by name; one whose file is missing or damaged has 0 columns
  std::vector<std::string> warnings;
};

/// Opens every image's header and brings together file, camera, sun and time. What is wrong with one image is
/// a warning and not an error: its own work fails, the rest goes on. Images a camera file names and `files`
/// lacks are listed as missing, unless `files` names single images only. Throws Error where there are no
/// images at all or a camera file cannot be read. The sun, first that is known: `sun`; the camera file; the
/// label (an orthophoto: as azimuth; else as image angle); time and place on Earth.
ListedImages list_images(const ImageListing& listing);

}  // namespace waymark
