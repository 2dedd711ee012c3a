// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "importers/points/las_point.hpp"
namespace waymark::importers {

/// Decodes a chunk of point formats 0 to 5, compressed point by point (items of version 2). Values that
/// LasPoint does not have are followed only as far as the position in the chunk depends on them.
/// Throws DamagedChunk. About 3 M points/s.
std::vector<LasPoint> pointwise_points(std::span<const unsigned char> chunk, const LasHeader& header,
                                       std::uint64_t count);

}  // namespace waymark::importers
