// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
namespace waymark {

/// Position along the Hilbert curve that fills the 65536 x 65536 grid: neighbours on the curve are neighbours
/// in the plane (Skilling 2004, in two dimensions).
std::uint32_t hilbert_index(std::uint16_t column, std::uint16_t row);

}  // namespace waymark
