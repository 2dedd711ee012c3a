// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
namespace waymark::importers {

struct LasHeader;

/// Types of the parts of a LAZ point, as numbered in its record.
enum class LazType : std::uint16_t {
  bytes = 0,
  point10 = 6,
  gps_time = 7,
  rgb12 = 8,
  wave13 = 9,
  point14 = 10,
  rgb14 = 11,
  rgbnir14 = 12,
  wave14 = 13,
  bytes14 = 14,
};

struct LazItem {
  LazType type{};
  std::uint16_t size = 0, version = 0;
};

/// How the points of a LAZ file are compressed: the record "laszip encoded", 22204.
struct LazRecord {
  static constexpr std::uint32_t kAnyCount = 0xFFFFFFFF;  ///< chunks of different numbers of points
  std::uint16_t compressor = 0;                           ///< 1 all points, 2 chunks, 3 chunks of layers
  std::uint16_t coder = 0;
  std::uint32_t chunk_points = kAnyCount;
  std::vector<LazItem> items = {};
};

/// Returns the contents of the record; no items if it is cut off.
LazRecord laz_record(const std::vector<unsigned char>& body);

/// Throws Error{input} if the header's record is missing, contradicts the point format, or names a version
/// that cannot be read: 2 of point formats 0 to 5 (1 of waveforms), 3 and 4 of 6 to 10 can.
void check_laz(const LasHeader& header);

}  // namespace waymark::importers
