// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "geo/image_source.hpp"
#include "importers/gdal_session.hpp"
namespace waymark {

/// Brightness of a window, NaN outside the image and where there is no data. `band` as ImageImport has it.
/// Reads strips of rows: beside the result about 16 MB. Throws Error{input} where the file is damaged.
Pixels read_pixels(GDALDataset& dataset, const Window& window, int band, const std::string& path);

}  // namespace waymark
