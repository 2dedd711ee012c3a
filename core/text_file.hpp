// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include "core/error.hpp"
namespace waymark::inline core {

/// Returns the content of a file. Throws Error{code}, "cannot read `what`", if the file does not exist, is a
/// folder or a device without end, or cannot be read.
std::string read_text(const std::filesystem::path& file, std::string_view what,
                      ErrorCode code = ErrorCode::input, std::string_view hint = "check the path");

}  // namespace waymark::inline core
