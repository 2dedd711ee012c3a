// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include "importers/gdal_session.hpp"
namespace waymark::importers {

/// Source of a focal length, the best first.
enum class FocalSource {
  plane_resolution,  ///< EXIF focal length and resolution of the focal plane
  film_equivalent,   ///< EXIF focal length for 35 mm film
  none,              ///< 0.85 of the longer side, as most cameras have
};

/// Position by satellite navigation.
struct PhotoPosition {
  double lon = 0, lat = 0;              ///< degrees
  std::optional<double> altitude = {};  ///< metres; of the ellipsoid, sea level or a barometer
};

/// Attitude of the gimbal (XMP of DJI), degrees.
struct GimbalAngles {
  double yaw = 0;    ///< clockwise from true north
  double pitch = 0;  ///< up from the horizon: -90 looks straight down
  double roll = 0;   ///< clockwise about the view
};

/// Metadata that cameras write into pictures: EXIF and XMP. Each may be absent.
struct PhotoMetadata {
  std::int64_t columns = 0, rows = 0;
  std::string camera = {};  ///< make and model; empty: unknown
  double focal = 0;         ///< pixels of this file
  double focal_sd = 0.2;    ///< as a fraction
  FocalSource focal_source = FocalSource::none;
  std::optional<PhotoPosition> position = {};
  std::optional<double> height_above_takeoff = {};  ///< metres
  std::optional<GimbalAngles> gimbal = {};
  int orientation = 1;         ///< EXIF: how a viewer turns the picture; pixels are as stored
  bool is_orthophoto = false;  ///< has a georeference: no frame image
};

/// Reads the metadata of a picture. Values out of range count as absent. Focal lengths are scaled where the
/// file was resized (EXIF pixel dimensions).
PhotoMetadata read_photo_metadata(GDALDataset& dataset, const std::string& path);

}  // namespace waymark::importers
