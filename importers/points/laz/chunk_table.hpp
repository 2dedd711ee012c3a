// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "importers/points/las_header.hpp"
namespace waymark::importers {

/// A part of a LAZ file that is decoded alone.
struct LazChunk {
  std::uint64_t offset = 0, bytes = 0, points = 0;
};

/// Reads the table of the chunks, in the order of the file; a file without chunks is one chunk.
/// Throws Error{input} if it is missing, leaves the file, or disagrees with the header's number of points.
std::vector<LazChunk> read_chunk_table(const LasHeader& header);

}  // namespace waymark::importers
