// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "geo/georeference.hpp"
#include "importers/gdal_session.hpp"
namespace waymark::importers {

/// Size and properties of an image file.
struct ImageHeader {
  std::int64_t columns = 0, rows = 0;
  double saturated = 0;
};

/// Reads the header. Throws Error{input} for a file without raster, a missing band, complex numbers.
ImageHeader read_image_header(GDALDataset& dataset, const std::string& path, int band);

/// Returns the georeference of an orthophoto; `std::nullopt` for an image without one. A non-empty `crs`
/// replaces the file's own. Throws Error{input} for degrees, rotated and south-up images, with the command
/// that corrects them.
std::optional<Georeference> orthophoto_georeference(GDALDataset& dataset, const std::string& path,
                                                    const std::string& crs,
                                                    std::vector<std::string>& warnings);

}  // namespace waymark::importers
