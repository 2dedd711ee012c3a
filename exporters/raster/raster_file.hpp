// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include "core/grid.hpp"
#include "geo/georeference.hpp"
namespace waymark::exporters {

/// Writes a compressed GeoTIFF of 32-bit floats with NaN as no data. The georeference is of cell centres; a
/// local CRS leaves the file without one. Equal cells give equal bytes. Throws Error{output}.
void write_raster(const std::filesystem::path& path, const Grid<float>& cells, const Georeference& where);

}  // namespace waymark::exporters
