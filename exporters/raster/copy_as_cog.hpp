// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include "core/atomic_file.hpp"
#include "exporters/gdal_messages.hpp"
class GDALDataset;
namespace waymark::exporters {

/// Writes a raster as a cloud-optimized GeoTIFF with overviews in place of `path`. As many threads compress
/// as the program may use; the bytes do not depend on them. Throws Error{output}.
void copy_as_cog(GDALDataset& raster, AtomicFile& aside, const std::filesystem::path& path,
                 GdalMessages& messages);

}  // namespace waymark::exporters
