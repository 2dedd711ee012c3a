// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include "geo/crs.hpp"
namespace waymark::importers {

/// Header of a LAS file (ASPRS LAS 1.0 to 1.4, R15).
struct LasHeader {
  std::string path;
  int minor_version = 2;                      ///< of 1.x
  int point_format = 0;                       ///< 0 to 10
  int point_length = 20;                      ///< bytes
  std::uint64_t first_point = 0, points = 0;  ///< offset in bytes; count
  std::array<double, 3> scale{1, 1, 1}, offset{}, low{}, high{};
  std::optional<Crs> crs;        ///< horizontal; std::nullopt if the file names none or an unknown one
  double metres_per_height = 0;  ///< of the vertical unit; 0: unknown
};

/// Reads and checks the header and the records that name the CRS. Counts are 64-bit if the version has them.
/// Throws Error{input} for a file that is no LAS file, damaged, LAZ (by its compression bit, whatever its
/// name), a point format above 10, a record shorter than its format, or fewer points than the header states.
LasHeader read_las_header(const std::string& path);

}  // namespace waymark::importers
