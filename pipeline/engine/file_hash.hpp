// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include "core/input_file.hpp"
namespace waymark::pipeline {

/// Returns size and hash of a file that a stage reads. importers/ has an implementation that opens /vsi
/// paths.
using FileHasher = std::function<InputFile(const std::string& path)>;

/// Returns size and SHA-256 of a plain file, read as a stream. Throws Error{input} if it cannot be read.
InputFile hash_plain_file(const std::string& path);

}  // namespace waymark::pipeline
