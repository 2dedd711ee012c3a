// SPDX-License-Identifier: Apache-2.0
#include "importers/points/las_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/error.hpp"
#include "importers/vsi_file.hpp"

namespace waymark::importers {
namespace {

// Offsets of the fields of a record; formats 6 to 10 have wider return numbers and classes.
LasPoint decoded(const unsigned char* record, const LasHeader& header) {
  std::int32_t raw[3];
  std::memcpy(raw, record, sizeof raw);
  LasPoint point;
  point.x = header.offset[0] + header.scale[0] * raw[0];
  point.y = header.offset[1] + header.scale[1] * raw[1];
  point.z = header.offset[2] + header.scale[2] * raw[2];
  const bool wide = header.point_format >= 6;
  point.return_number = static_cast<std::uint8_t>(record[14] & (wide ? 0x0F : 0x07));
  point.classification = static_cast<std::uint8_t>(wide ? record[16] : record[15] & 0x1F);
  point.withheld = (record[15] & (wide ? 0x04 : 0x80)) != 0;
  return point;
}

}  // namespace

std::vector<LasPoint> read_las_points(const LasHeader& header, std::uint64_t first, std::uint64_t count) {
  VsiFile file(header.path);
  const auto length = static_cast<std::size_t>(header.point_length);
  std::vector<LasPoint> points(static_cast<std::size_t>(count));
  std::vector<unsigned char> bytes(static_cast<std::size_t>(std::min(count, kLasChunk)) * length);
  for (std::uint64_t done = 0; done < count;) {
    const std::uint64_t part = std::min(kLasChunk, count - done);
    const std::size_t wanted = static_cast<std::size_t>(part) * length;
    if (file.read(header.first_point + (first + done) * length, bytes.data(), wanted) != wanted)
      throw Error(ErrorCode::input, fmt::format("the file ends before its point {}", first + done + part),
                  header.path, "copy or download it again");
    for (std::uint64_t i = 0; i < part; ++i)
      points[static_cast<std::size_t>(done + i)] =
          decoded(bytes.data() + static_cast<std::size_t>(i) * length, header);
    done += part;
  }
  return points;
}

}  // namespace waymark::importers
