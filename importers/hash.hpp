// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "core/input_file.hpp"
namespace waymark::importers {

/// Returns size and SHA-256 (FIPS 180-4) of a file, `/vsi...` paths included; a FileHasher of the engine.
/// - A raster of several files (a VRT and its sources, masks, `.aux.xml`) is hashed as their concatenation.
/// - A folder is hashed as its files; a path that ends in '/' as the names and sizes of the images in it.
/// - A pattern (*.tsai) is hashed as the files it matches.
/// Reads in pieces: about 400 MB/s, 1 MiB of memory. Throws Error{input} if a file cannot be read.
InputFile hash_file(const std::string& path);

/// Lists the files whose content hash_file() reads, in its order; none for a path that ends in '/'. Throws
/// Error{input} for a pattern that matches no file.
std::vector<std::string> hashed_files(const std::string& path);

/// Lists the files of a raster in GDAL's order, the raster itself first if it is a file. Throws Error{input}
/// if GDAL cannot open it.
std::vector<std::string> raster_file_list(const std::string& raster);

}  // namespace waymark::importers
