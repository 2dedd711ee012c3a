// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>
#include "importers/points/laz/chunk_table.hpp"
namespace waymark::importers {

/// Returns the contents of the record "copc", 1; `std::nullopt` if it is too short.
std::optional<CopcRecord> copc_record(const std::vector<unsigned char>& body);

/// A node of the octree of a COPC file: a LAZ chunk whose points lie in a cube.
struct CopcNode {
  LazChunk chunk;
  int level = 0;                        ///< 0: the root, which samples the whole area
  std::array<double, 3> low{}, high{};  ///< units of the file
};

/// Reads the hierarchy of a COPC 1.0 file: the nodes that have points, by level, then in the order of the
/// file. Throws Error{input} if it contradicts the header or leaves the file.
std::vector<CopcNode> read_copc_nodes(const LasHeader& header);

}  // namespace waymark::importers
