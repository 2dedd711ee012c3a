// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "geo/image_source.hpp"
namespace waymark::importers {

/// Metadata of an image that its file does not hold.
struct ImageImport {
  /// A posed frame camera; the file's own georeference is then ignored.
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

/// An image in a file that GDAL reads.
class ImportedImage : public ImageSource {
 public:
  /// Returns one line per warning, in a fixed order.
  virtual const std::vector<std::string>& warnings() const = 0;
  virtual int band() const = 0;  ///< as in ImageImport
};

/// Opens an image: GeoTIFF, COG, PNG, JPEG, PGM, PDS3/PDS4/ISIS and all other formats of GDAL; 8, 16, 32 bit,
/// float, palette. Reads the header only.
/// - Pixels are as the file stores them: EXIF orientation is ignored, as in camera files.
/// - No data are the no-data value (of a colour image: in every colour), mask, alpha 0, ISIS special values
///   and NaN.
/// - An orthophoto has its Georeference in `info().ortho`, from GeoTIFF keys, world file or any source of
///   GDAL.
/// - An orthophoto in degrees, rotated or south-up is refused with the gdalwarp command that corrects it,
///   unless `georeference` is false.
/// - A georeferenced file without CRS is in Crs::local(), with a warning.
/// Throws Error{input} for a file that is missing, damaged, complex or no image.
std::shared_ptr<const ImportedImage> import_image(const std::string& path, const ImageImport& import = {});

/// Returns a transverse Mercator on the body of `crs` as a PROJ string, which gdalwarp -t_srs takes. It is
/// true to scale along the meridian of the position. Scale error below 1e-4 within 90 km on Earth, 48 km on
/// Mars. Degrees are rounded to 1e-4.
std::string local_projection(const Crs& crs, double lon, double lat);

}  // namespace waymark::importers
