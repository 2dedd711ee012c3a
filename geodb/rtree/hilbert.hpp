// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
namespace waymark::geodb {

/// Returns the index on the Hilbert curve that fills the 65536 x 65536 grid (Skilling 2004, two dimensions).
/// Neighbours on the curve are neighbours in the plane.
std::uint32_t hilbert_index(std::uint16_t column, std::uint16_t row);

}  // namespace waymark::geodb
