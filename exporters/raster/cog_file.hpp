// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>
#include "core/grid.hpp"
#include "geo/georeference.hpp"
namespace waymark::exporters {

/// Band of a raster with its name.
struct RasterBand {
  std::string name = {};          ///< description of the band
  std::string unit = {};          ///< "m", "deg"; empty: none
  const Grid<float>* cells = {};  ///< NaN: no data; all bands of one size
};

/// Writes a cloud-optimized GeoTIFF of 32-bit floats with overviews and NaN as no data. Equal input gives
/// equal bytes. Throws Error{output}.
/// - `metadata` becomes items of the file.
/// - The georeference is of cell centres; a local CRS leaves the file without a CRS.
void write_cog(const std::filesystem::path& path, const std::vector<RasterBand>& bands,
               const Georeference& where, const std::map<std::string, std::string>& metadata = {});

}  // namespace waymark::exporters
