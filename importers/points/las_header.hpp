// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include "geo/crs.hpp"
#include "importers/points/laz/laz_record.hpp"
namespace waymark::importers {

/// The octree of a COPC 1.0 file: the record "copc", 1.
struct CopcRecord {
  std::array<double, 3> centre{};  ///< of the cube of the root, units of the file
  double half_side = 0;
  std::uint64_t root_offset = 0, root_bytes = 0;  ///< of the first page of the hierarchy
};

/// Header of a LAS or LAZ file (ASPRS LAS 1.0 to 1.4, R15).
struct LasHeader {
  std::string path;
  int minor_version = 2;                      ///< of 1.x
  int point_format = 0;                       ///< 0 to 10
  int point_length = 20;                      ///< bytes
  std::uint64_t first_point = 0, points = 0;  ///< offset in bytes; count
  std::array<double, 3> scale{1, 1, 1}, offset{}, low{}, high{};
  std::optional<Crs> crs;               ///< horizontal; std::nullopt if the file names none or an unknown one
  double metres_per_height = 0;         ///< of the vertical unit; 0: unknown
  std::uint64_t first_returns = 0;      ///< as stated; 0 if it is not
  std::optional<LazRecord> laz = {};    ///< `std::nullopt` if the points are not compressed
  std::optional<CopcRecord> copc = {};  ///< of a COPC file, which is LAZ as well
};

/// Reads and checks the header and the records that name the CRS. Counts are 64-bit if the version has them.
/// LAZ and COPC are recognised by their contents, whatever the name of the file.
/// Throws Error{input} for:
/// - a file that is no LAS file, is damaged, or is compressed in an unknown way;
/// - a point format above 10, a record shorter than its format, fewer points than the header states.
LasHeader read_las_header(const std::string& path);

}  // namespace waymark::importers
