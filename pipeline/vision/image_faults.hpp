// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include "geo/image_source.hpp"
namespace waymark::pipeline {

/// Returns why an image yields few or no detections; `std::nullopt` if it is usable. O(pixels).
/// - It is smaller than 16 pixels.
/// - All pixels are equal (black, saturated, no data).
/// - More than a twentieth of the pixels are at or above `saturated` (0: unknown).
std::optional<std::string> image_fault(const Pixels& pixels, double saturated);

}  // namespace waymark::pipeline
