// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "importers/points/las_point.hpp"
namespace waymark::importers {

/// A rectangle in the units of the files.
struct LasBox {
  double left = 0, low = 0, right = 0, high = 0;
  bool intersects(const LasBox& b) const {
    return left <= b.right && b.left <= right && low <= b.high && b.low <= high;
  }
};

inline constexpr std::uint64_t kLasChunk = std::uint64_t{1} << 16;

/// A part of a file that is read alone: up to 65,536 points of LAS, a chunk of LAZ, a node of COPC.
struct LasRun {
  std::uint64_t offset = 0, bytes = 0, points = 0;
  int level = 0;                   ///< of a COPC node; 0 is the root
  std::optional<LasBox> box = {};  ///< `std::nullopt` if the file does not state it
};

/// Returns the runs of a file, in its order; those of COPC by level. Throws Error{input} as read_chunk_table
/// and read_copc_nodes do.
std::vector<LasRun> las_runs(const LasHeader& header);

/// Reads the points of a run. Throws Error{input} if the file ends early, the bytes are damaged, or a point
/// lies outside the box of its run. LAS about 10 M points/s, LAZ 3 to 5 M points/s.
std::vector<LasPoint> read_run(const LasHeader& header, const LasRun& run);

/// Reads points `first` to `first + count` of an uncompressed file, in its order. Throws Error{input} if the
/// file ends early. About 10 M points/s.
std::vector<LasPoint> read_las_points(const LasHeader& header, std::uint64_t first, std::uint64_t count);

}  // namespace waymark::importers
