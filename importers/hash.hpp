// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "core/input_file.hpp"
namespace waymark {

/// Size and SHA-256 (FIPS 180-4) of a file, `/vsi...` paths included; a FileHasher of the engine. A raster
/// that is made of several files (a VRT and its sources, masks, `.aux.xml`) is hashed as all of them, one
/// after the other. A folder is hashed as the files in it; a path that ends in '/' as the names and sizes of
/// the images in that folder, if there is one; a pattern (*.tsai) as the
/// files it matches. Read in pieces: about 400 MB/s, 1 MiB of memory. Throws
/// Error{input} where a file cannot be read.
InputFile hash_file(const std::string& path);

/// The files a raster is made of, in the order GDAL lists them, itself first where it is a file.
/// Throws Error{input} where GDAL cannot open it.
std::vector<std::string> files_behind(const std::string& raster);

}  // namespace waymark
