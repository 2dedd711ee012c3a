// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "geo/image_source.hpp"
namespace waymark {

/// What is known of an image beside its file.
struct ImageImport {
  /// A frame camera at a place: the file's own georeference, if any, is not looked at.
  std::optional<PosedCamera> view = {};
  std::string crs = {};      ///< of `view`; of an orthophoto instead of its own; "local": metres on no body
  bool georeference = true;  ///< false: pixels only, whatever the file says
  std::optional<Sun> sun = {};
  std::optional<Degrees> image_sun_angle = {};
  std::optional<Meters> gsd = {};
  double saturated = 0;  ///< 0: 255 of 8-bit, 65535 of 16-bit images
  std::string taken_utc = {};
  int band = 0;  ///< from 1; 0: luminance of a colour image, else the first band
};

/// An image on a file that GDAL reads.
class ImportedImage : public ImageSource {
 public:
  /// One line each, in a fixed order.
  virtual const std::vector<std::string>& warnings() const = 0;
  virtual int band() const = 0;  ///< as ImageImport has it
};

/// Opens an image: GeoTIFF, COG, PNG, JPEG, PGM, PDS3/PDS4/ISIS and whatever else GDAL reads; 8, 16, 32 bit,
/// float, palette. Only the header is read. Pixels are as the file stores them (EXIF orientation is ignored,
/// as camera files do). No data: the no-data value (of a colour image: in every colour), mask, alpha 0, ISIS
/// special values, NaN. An orthophoto has its Georeference in `info().ortho`, by GeoTIFF keys, world file or
/// whatever GDAL knows; one in degrees, rotated or south-up is refused with the gdalwarp command that mends
/// it, unless `georeference` is false. A georeferenced file that names no CRS is in Crs::local(), with a
/// warning. Throws Error{input} for what is missing, damaged, complex or no image.
std::shared_ptr<const ImportedImage> import_image(const std::string& path, const ImageImport& import = {});

/// A definition (PROJ string, also for gdalwarp -t_srs) of a transverse Mercator on the body of `crs`, true
/// to scale along the meridian of a place: better than 1e-4 within 90 km of it on Earth, 48 km on Mars.
/// Degrees, rounded to 1e-4, so that it is short.
std::string local_projection(const Crs& crs, double lon, double lat);

}  // namespace waymark
