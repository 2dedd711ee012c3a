// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "core/input_file.hpp"
namespace waymark {

/// Size and SHA-256 (FIPS 180-4) of a file, `/vsi...` paths included; a FileHasher of the engine. Read in
/// pieces: about 400 MB/s, 1 MiB of memory. Throws Error{input} where the file cannot be read.
InputFile hash_file(const std::string& path);

/// The files a raster is made of, itself first: sources of a VRT, masks, `.aux.xml`. What is not a file, such
/// as the description of a VRT, names only its sources. Throws Error{input} where GDAL cannot open it.
std::vector<std::string> files_behind(const std::string& raster);

}  // namespace waymark
