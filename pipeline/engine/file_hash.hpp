// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include "core/input_file.hpp"
namespace waymark {

/// Measures a file a stage reads. importers/ has one that opens /vsi paths.
using FileHasher = std::function<InputFile(const std::string& path)>;

/// Size and SHA-256 of a plain file, streamed. Throws Error{input} where it cannot be read.
InputFile hash_plain_file(const std::string& path);

}  // namespace waymark
