// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include "geo/image_source.hpp"
namespace waymark::exporters {

/// Writes a grey PNG of 8 or 16 bits; brightness 1 becomes the largest value, NaN becomes 0. Throws
/// Error{output}.
void write_image(const std::filesystem::path& path, const Pixels& image, int bits);

}  // namespace waymark::exporters
