// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
class GDALDataset;
namespace waymark::importers {

/// Throws Error{input} for a raster that GDAL opens, but would read without end, with all memory or as zeros:
/// a text grid that lacks rows, blocks too large for the file, a file without compression that ends early.
/// Reads a text grid whole; others cost nothing.
void check_raster_file(GDALDataset& dataset, const std::string& path);

}  // namespace waymark::importers
