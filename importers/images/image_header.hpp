// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "geo/georeference.hpp"
#include "importers/gdal_session.hpp"
namespace waymark {

/// What an image file says of itself.
struct ImageHeader {
  std::int64_t columns = 0, rows = 0;
  bool placed = false;  ///< has a georeference of whatever kind
  double saturated = 0;
};

/// Throws Error{input} for a file without raster, a missing band, complex numbers.
ImageHeader read_image_header(GDALDataset& dataset, const std::string& path, int band);

/// Where an orthophoto's pixels lie; nothing for an image without georeference. `crs` replaces its own unless
/// empty. Refuses degrees, rotated and south-up images with the command that mends them.
std::optional<Georeference> orthophoto_place(GDALDataset& dataset, const std::string& path,
                                             const std::string& crs, std::vector<std::string>& warnings);

}  // namespace waymark
