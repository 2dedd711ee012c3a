// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "importers/points/las_header.hpp"
namespace waymark::importers {

/// A laser return, in the units of the file.
struct LasPoint {
  double x = 0, y = 0, z = 0;
  std::uint8_t classification = 0;  ///< 2 ground; 7 and 18 noise
  std::uint8_t return_number = 1;   ///< from 1; 0: not numbered
  bool withheld = false;
};

inline constexpr std::uint64_t kLasChunk = std::uint64_t{1} << 16;

/// Reads points `first` to `first + count` of a file, in its order. Throws Error{input} if the file ends
/// early. About 10 M points/s.
std::vector<LasPoint> read_las_points(const LasHeader& header, std::uint64_t first, std::uint64_t count);

}  // namespace waymark::importers
