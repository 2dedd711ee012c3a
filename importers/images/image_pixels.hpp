// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "geo/image_source.hpp"
#include "importers/gdal_session.hpp"
namespace waymark::importers {

/// Reads the brightness of a window; NaN outside the image and for no data. `band` as in ImageImport. Reads
/// strips of rows: about 16 MB beside the result. Throws Error{input} if the file is damaged.
Pixels read_pixels(GDALDataset& dataset, const Window& window, int band, const std::string& path);

}  // namespace waymark::importers
