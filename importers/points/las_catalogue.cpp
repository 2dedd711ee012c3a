// SPDX-License-Identifier: Apache-2.0
#include "importers/points/las_catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

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

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr LasBox kNowhere{kFar, kFar, -kFar, -kFar};

void include(LasBox& box, double x, double y) {
  box.left = std::min(box.left, x), box.right = std::max(box.right, x);
  box.low = std::min(box.low, y), box.high = std::max(box.high, y);
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

LasCatalogue::LasCatalogue(const std::vector<std::string>& files, std::int64_t memory_bytes)
    : box_(kNowhere),
      kept_runs_(
          std::max<std::size_t>(4, static_cast<std::size_t>(memory_bytes) / (kLasChunk * sizeof(LasPoint)))) {
  for (const std::string& file : files) headers_.push_back(read_las_header(file));
  for (std::size_t f = 0; f < headers_.size(); ++f)
    for (std::uint64_t first = 0; first < headers_[f].points; first += kLasChunk) {
      Run run{f, first, std::min(kLasChunk, headers_[f].points - first), kNowhere};
      for (const LasPoint& p : read_las_points(headers_[f], first, run.count)) {
        if (!is_usable(p)) {
          ++excluded_;
          continue;
        }
        ++points_;
        ground_ += p.classification == 2;
        first_returns_ += is_first(p);
        include(run.box, p.x, p.y);
      }
      if (run.box.left > run.box.right) continue;
      include(box_, run.box.left, run.box.low), include(box_, run.box.right, run.box.high);
      runs_.push_back(run);
    }
}

LasCatalogue::Points LasCatalogue::points_of(std::size_t run) const {
  {
    const std::scoped_lock lock(mutex_);
    if (const auto found = at_.find(run); found != at_.end()) {
      kept_.splice(kept_.begin(), kept_, found->second);
      return found->second->second;
    }
  }
  const Run& r = runs_[run];
  auto points =
      std::make_shared<const std::vector<LasPoint>>(read_las_points(headers_[r.file], r.first, r.count));
  const std::scoped_lock lock(mutex_);
  if (!at_.contains(run)) {
    kept_.emplace_front(run, points);
    at_[run] = kept_.begin();
    while (kept_.size() > kept_runs_) {
      at_.erase(kept_.back().first);
      kept_.pop_back();
    }
  }
  return points;
}

void LasCatalogue::visit(const LasBox& box, const std::function<void(const LasPoint&)>& use) const {
  for (std::size_t run = 0; run < runs_.size(); ++run) {
    if (!runs_[run].box.intersects(box)) continue;
    for (const LasPoint& p : *points_of(run))
      if (is_usable(p) && p.x >= box.left && p.x <= box.right && p.y >= box.low && p.y <= box.high) use(p);
  }
}

}  // namespace waymark::importers
