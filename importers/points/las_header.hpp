// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include "geo/crs.hpp"
namespace waymark {

/// What a LAS file says of itself (ASPRS LAS 1.0 to 1.4, R15).
struct LasHeader {
  std::string path;
  int minor_version = 2;                      ///< of 1.x
  int point_format = 0;                       ///< 0 to 10
  int point_length = 20;                      ///< bytes
  std::uint64_t first_point = 0, points = 0;  ///< offset in bytes; count
  std::array<double, 3> scale{1, 1, 1}, offset{}, low{}, high{};
  std::optional<Crs> crs;  ///< horizontal; none: the file does not say, or says it in a way we do not know
  double metres_per_height = 0;  ///< of the vertical unit; 0: not told
};

/// Reads and checks the header and the records that name the CRS. Counts are 64-bit where the version has
/// them. Throws Error{input}: no LAS file, damaged, LAZ (told by its compression bit, whatever its name
/// is), a point format above 10, a record shorter than its format, fewer points than promised.
LasHeader read_las_header(const std::string& path);

}  // namespace waymark
