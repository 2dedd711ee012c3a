// SPDX-License-Identifier: Apache-2.0
#include "importers/points/las_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.hpp"
#include "importers/points/laz/arithmetic_decoder.hpp"
#include "importers/points/laz/chunk_table.hpp"
#include "importers/points/laz/copc.hpp"
#include "importers/points/laz/layered_points.hpp"
#include "importers/points/laz/pointwise_points.hpp"
#include "importers/vsi_file.hpp"

namespace waymark::importers {
namespace {

std::vector<LasRun> runs_of_copc(const LasHeader& header) {
  std::vector<LasRun> runs;
  for (const CopcNode& node : read_copc_nodes(header))
    runs.push_back({node.chunk.offset, node.chunk.bytes, node.chunk.points, node.level,
                    LasBox{node.low[0], node.low[1], node.high[0], node.high[1]}});
  return runs;
}

std::vector<LasPoint> decoded_chunk(const LasHeader& header, const LasRun& run) {
  std::vector<unsigned char> bytes(static_cast<std::size_t>(run.bytes));
  VsiFile file(header.path);
  if (file.read(run.offset, bytes.data(), bytes.size()) != bytes.size())
    throw Error(ErrorCode::input, fmt::format("the file ends within the points at byte {}", run.offset),
                header.path, "copy or download it again");
  try {
    return header.point_format >= 6 ? layered_points(bytes, header, run.points)
                                    : pointwise_points(bytes, header, run.points);
  } catch (const DamagedChunk&) {
    throw Error(ErrorCode::input,
                fmt::format("the compressed points at bytes {} to {} are damaged", run.offset,
                            run.offset + run.bytes),
                header.path, "copy or download it again");
  }
}

// A window is answered from the boxes alone, so points outside them would be lost without notice.
void check_box(const LasHeader& header, const LasRun& run, const std::vector<LasPoint>& points) {
  const auto slack = [&](std::size_t axis) {
    return 2 * std::abs(header.scale[axis]) +
           1e-9 * std::max(std::abs(header.low[axis]), std::abs(header.high[axis]));
  };
  const double dx = slack(0), dy = slack(1);
  const double left = std::max(run.box->left, header.low[0]) - dx,
               right = std::min(run.box->right, header.high[0]) + dx,
               low = std::max(run.box->low, header.low[1]) - dy,
               high = std::min(run.box->high, header.high[1]) + dy;
  for (const LasPoint& p : points)
    if (!(p.x >= left && p.x <= right && p.y >= low && p.y <= high))
      throw Error(
          ErrorCode::input,
          fmt::format("the COPC file is damaged: point {:.2f} {:.2f} lies outside its node", p.x, p.y),
          header.path, "write it again from its source");
}

}  // namespace

LasPoint las_point(const unsigned char* record, const LasHeader& header) {
  std::int32_t raw[3];
  std::memcpy(raw, record, sizeof raw);
  LasPoint point;
  point.x = header.offset[0] + header.scale[0] * raw[0];
  point.y = header.offset[1] + header.scale[1] * raw[1];
  point.z = header.offset[2] + header.scale[2] * raw[2];
  const bool wide = header.point_format >= 6;  // wider return numbers and classes
  point.return_number = static_cast<std::uint8_t>(record[14] & (wide ? 0x0F : 0x07));
  point.return_count = static_cast<std::uint8_t>(wide ? record[14] >> 4 : record[14] >> 3 & 0x07);
  point.classification = static_cast<std::uint8_t>(wide ? record[16] : record[15] & 0x1F);
  point.withheld = (record[15] & (wide ? 0x04 : 0x80)) != 0;
  return point;
}

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
          las_point(bytes.data() + static_cast<std::size_t>(i) * length, header);
    done += part;
  }
  return points;
}

std::vector<LasRun> las_runs(const LasHeader& header) {
  if (header.copc) return runs_of_copc(header);
  std::vector<LasRun> runs;
  if (header.laz) {
    for (const LazChunk& chunk : read_chunk_table(header))
      if (chunk.points > 0) runs.push_back({chunk.offset, chunk.bytes, chunk.points});
    return runs;
  }
  const auto length = static_cast<std::uint64_t>(header.point_length);
  for (std::uint64_t first = 0; first < header.points; first += kLasChunk) {
    const std::uint64_t count = std::min(kLasChunk, header.points - first);
    runs.push_back({header.first_point + first * length, count * length, count});
  }
  return runs;
}

std::vector<LasPoint> read_run(const LasHeader& header, const LasRun& run) {
  if (!header.laz)
    return read_las_points(
        header, (run.offset - header.first_point) / static_cast<std::uint64_t>(header.point_length),
        run.points);
  std::vector<LasPoint> points = decoded_chunk(header, run);
  if (run.box) check_box(header, run, points);
  return points;
}

}  // namespace waymark::importers
