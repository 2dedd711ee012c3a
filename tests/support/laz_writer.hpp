// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>
namespace waymark::test {

/// All that a point record of any format has; coordinates in steps of the scale.
struct RawPoint {
  std::array<std::int32_t, 3> at{};
  std::uint16_t intensity = 0, source = 0;
  std::uint8_t number = 1, returns = 1, classification = 0, user_data = 0;
  std::uint8_t flags = 0;  ///< 1 synthetic, 2 key point, 4 withheld, 8 overlap, 16 scan direction, 32 edge
  std::uint8_t channel = 0;
  std::int16_t angle = 0;
  std::int64_t time = 0;  ///< the bits of the double
  std::array<std::uint16_t, 4> colour{};
};

struct LazFile {
  int format = 6, extra_bytes = 0;
  std::vector<std::vector<RawPoint>> chunks = {};
  bool variable = false;      ///< chunks of any size; else all but the last are as large as the first
  bool whole = false;         ///< compressor 1: no chunks (formats 0 to 5)
  bool table_at_end = false;  ///< the position of the table in the last 8 bytes, as a pipe leaves it
  std::array<double, 3> origin{500000, 5000000, 0};
  double scale = 0.001;
  int epsg = 32633;
};

int point_length(int format, int extra_bytes);

/// Returns a record as LAS stores it.
std::string las_record(const RawPoint& point, int format, int extra_bytes);

/// Returns a LAZ file. Values that the reader skips are written with the right syntax, not the right numbers.
std::string laz_bytes(const LazFile& file);

/// Returns the same points as an uncompressed file.
std::string las_bytes(const LazFile& file);

/// Returns a COPC file of format 6: the root and the levels below it take the points in turn. Pages of the
/// hierarchy are split at level 1.
std::string copc_bytes(const LazFile& file, int levels);

}  // namespace waymark::test
