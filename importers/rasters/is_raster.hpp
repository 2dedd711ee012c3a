// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
namespace waymark::importers {

/// Returns whether a file holds cells and no table. A GeoPackage with both counts as a table; name its tiles
/// as "GPKG:<path>:<table>". A file that does not open is no raster.
bool is_raster(const std::string& path);

}  // namespace waymark::importers
