// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include "geo/image_source.hpp"
namespace waymark {

/// Why nothing, or little, can be found in an image, for people: it is smaller than 16 pixels, all its pixels
/// are alike (black, blown out, no data), or more than a twentieth of them are `saturated` or above (0:
/// unknown). Nothing where it looks usable. O(pixels).
std::optional<std::string> image_fault(const Pixels& pixels, double saturated);

}  // namespace waymark
