// SPDX-License-Identifier: Apache-2.0
#include "importers/points/las_catalogue.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <exception>
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

// What is known of a run once it was read.
struct Summary {
  LasBox box = kNowhere;
  std::uint64_t points = 0, ground = 0, first_returns = 0, excluded = 0;
  std::exception_ptr error;
};

Summary summary_of(const std::vector<LasPoint>& points) {
  Summary summary;
  for (const LasPoint& p : points) {
    if (!is_usable(p)) {
      ++summary.excluded;
      continue;
    }
    ++summary.points;
    summary.ground += p.classification == 2;
    summary.first_returns += is_first(p);
    include(summary.box, p.x, p.y);
  }
  return summary;
}

void check_bounds(const LasHeader& header) {
  bool sound = true;
  for (const std::size_t axis : {0, 1})
    sound = sound && std::isfinite(header.low[axis]) && std::isfinite(header.high[axis]) &&
            header.low[axis] <= header.high[axis];
  if (!sound)
    throw Error(ErrorCode::input,
                fmt::format("the header of the COPC file states bounds of {} to {} and {} to {}",
                            header.low[0], header.high[0], header.low[1], header.high[1]),
                header.path, "write it again from its source");
}

}  // namespace

LasCatalogue::LasCatalogue(const std::vector<std::string>& files, std::int64_t memory_bytes)
    : box_(kNowhere),
      max_kept_(
          std::max(4 * std::size_t{kLasChunk}, static_cast<std::size_t>(memory_bytes) / sizeof(LasPoint))) {
  for (const std::string& file : files) headers_.push_back(read_las_header(file));
  for (std::size_t f = 0; f < headers_.size(); ++f) add_file(f);
}

void LasCatalogue::add_file(std::size_t file) {
  const LasHeader& header = headers_[file];
  const std::vector<LasRun> runs = las_runs(header);
  const bool counted = header.first_returns > 0 && header.first_returns <= header.points;
  header.copc&& counted ? index_copc(file, runs) : index(file, runs);
}

// Levels are read until one has ground points: files without any are read whole.
void LasCatalogue::index_copc(std::size_t file, std::span<const LasRun> runs) {
  const LasHeader& header = headers_[file];
  check_bounds(header);
  const std::uint64_t ground = ground_, excluded = excluded_, points = points_, first = first_returns_;
  std::size_t done = 0;
  while (done < runs.size() && ground_ == ground) {
    std::size_t end = done;
    while (end < runs.size() && runs[end].level == runs[done].level) ++end;
    index(file, runs.subspan(done, end - done));
    done = end;
  }
  if (done == runs.size()) return;
  for (const LasRun& run : runs.subspan(done)) runs_.push_back({file, run, *run.box});
  points_ = points + header.points - (excluded_ - excluded);
  first_returns_ = first + header.first_returns;
  include(box_, header.low[0], header.low[1]), include(box_, header.high[0], header.high[1]);
  all_read_ = false;
}

void LasCatalogue::index(std::size_t file, std::span<const LasRun> runs) {
  std::vector<Summary> summaries(runs.size());
  tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t i) {
    try {
      summaries[i] = summary_of(read(headers_[file], runs[i]));
    } catch (...) {
      summaries[i].error = std::current_exception();
    }
  });
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Summary& summary = summaries[i];
    if (summary.error) std::rethrow_exception(summary.error);
    excluded_ += summary.excluded;
    points_ += summary.points;
    ground_ += summary.ground;
    first_returns_ += summary.first_returns;
    if (summary.points == 0) continue;
    include(box_, summary.box.left, summary.box.low), include(box_, summary.box.right, summary.box.high);
    runs_.push_back({file, runs[i], summary.box});
  }
}

std::vector<LasPoint> LasCatalogue::read(const LasHeader& header, const LasRun& run) const {
  ++decoded_;
  return read_run(header, run);
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
  auto points = std::make_shared<const std::vector<LasPoint>>(read(headers_[r.file], r.part));
  const std::scoped_lock lock(mutex_);
  if (!at_.contains(run)) {
    kept_.emplace_front(run, points);
    at_[run] = kept_.begin();
    kept_points_ += points->size();
    while (kept_points_ > max_kept_ && kept_.size() > 1) {
      kept_points_ -= kept_.back().second->size();
      at_.erase(kept_.back().first);
      kept_.pop_back();
    }
  }
  return points;
}

void LasCatalogue::visit(const LasBox& box, const std::function<void(const LasPoint&)>& use) const {
  for (std::size_t run = 0; run < runs_.size(); ++run) {
    if (!runs_[run].box.intersects(box)) continue;
    const Points points =
        points_of(run);  // held here: another thread may keep its own copy, or drop this one
    for (const LasPoint& p : *points)
      if (is_usable(p) && p.x >= box.left && p.x <= box.right && p.y >= box.low && p.y <= box.high) use(p);
  }
}

}  // namespace waymark::importers
