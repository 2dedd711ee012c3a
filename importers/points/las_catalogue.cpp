// SPDX-License-Identifier: Apache-2.0
#include "importers/points/las_catalogue.hpp"

#include <algorithm>
#include <limits>

#include "core/error.hpp"

namespace waymark::importers {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr LasBox kNowhere{kFar, kFar, -kFar, -kFar};

void include(LasBox& box, double x, double y) {
  box.left = std::min(box.left, x), box.right = std::max(box.right, x);
  box.low = std::min(box.low, y), box.high = std::max(box.high, y);
}

}  // namespace

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
