// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include "pipeline/engine/parts.hpp"
namespace waymark::pipeline {

/// Writes the bytes of encode_parts() with one part in memory. Returns their SHA-256. Throws
/// std::system_error.
std::string write_parts(const std::filesystem::path& file, const EncodedParts& parts);

/// Opens what write_parts() wrote; the parts are read from the file, which stays open. Throws
/// std::runtime_error if it cannot be read or its length is wrong.
EncodedParts open_parts(const std::filesystem::path& file);

}  // namespace waymark::pipeline
