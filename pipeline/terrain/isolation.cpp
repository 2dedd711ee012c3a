// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/isolation.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <queue>

#include "core/error.hpp"
#include "geo/metric_crs.hpp"
#include "pipeline/terrain/contact.hpp"
#include "pipeline/terrain/dem_chunks.hpp"
#include "pipeline/terrain/hidden_ground.hpp"
#include "pipeline/terrain/nearest_grid_point.hpp"

namespace waymark::pipeline {
namespace {

GridPoint grid_point(std::int64_t column, std::int64_t row) {
  return {static_cast<double>(column), static_cast<double>(row)};
}

// Search for successive summits; for one thread.
template <class Metric>
class Search {
 public:
  Search(const Metric& metric, const DemSource& dem, const ReliefPyramid& relief, IsolationEnd end)
      : metric_(metric), grid_(dem.geometry()), relief_(relief), cells_(dem), end_(end) {
    hidden_above_ = hidden_above(dem);
  }

  Isolation measure(const HighPoint& summit) {
    column_ = summit.cell % grid_.columns;
    row_ = summit.cell / grid_.columns;
    origin_ = metric_.origin(column_, row_);
    Isolation isolation;
    const auto higher =
        end_ == IsolationEnd::cell ? nearest_higher(summit.height) : nearest_contact(summit.height);
    if (higher) {
      isolation.metres = isolation.metres_low = higher->metres;
      isolation.higher = higher->point;
    }
    const auto hidden = nearest_hidden(isolation.metres);
    if (hidden) {
      const double certain = end_ == IsolationEnd::cell
                                 ? hidden->metres
                                 : std::max(0.0, hidden->metres - metric_.cell_diagonal());
      isolation.metres_low = std::min(isolation.metres_low.value_or(certain), certain);
    }
    return isolation;
  }

 private:
  using Nearest = NearestGridPoint<Metric>;
  using Found = std::optional<typename Nearest::Found>;

  Found nearest_higher(double height) {
    Nearest nearest(metric_, grid_point(column_, row_));
    search_blocks([&](const ReliefPyramid::Relief& r) { return r.highest > height; },
                  [&] { return nearest.limit(); },
                  [&](const Window& block) {
                    for_cells(block, [&](std::int64_t c, std::int64_t r, double z) {
                      if (z > height) nearest.offer(grid_point(c, r), metric_.squared(origin_, c, r));
                    });
                  });
    return nearest.resolve();
  }

  Found nearest_contact(double height) {
    Nearest nearest(metric_, grid_point(column_, row_));
    const Eigen::Vector3d from = metric_.position(grid_point(column_, row_));
    // A contour lies within a cell diagonal of its higher cell.
    const auto limit = [&] {
      const double metres = std::sqrt(nearest.limit()) + metric_.cell_diagonal();
      return metres * metres;
    };
    search_blocks([&](const ReliefPyramid::Relief& r) { return r.highest > height; }, limit,
                  [&](const Window& block) {
                    for_cells(block, [&](std::int64_t c, std::int64_t r, double z) {
                      if (z > height && metric_.squared(origin_, c, r) <= limit())
                        offer_contacts(metric_, from, height, c, r, cells_, nearest);
                    });
                  });
    return nearest.resolve();
  }

  Found nearest_hidden(std::optional<double> within) {
    Nearest nearest(metric_, grid_point(column_, row_));
    if (within) {
      const double metres = *within + metric_.slack(*within) + metric_.cell_diagonal();
      nearest.stop_at(metres * metres);
    }
    search_blocks([](const ReliefPyramid::Relief& r) { return r.voids; }, [&] { return nearest.limit(); },
                  [&](const Window& block) {
                    for_cells(block, [&](std::int64_t c, std::int64_t r, double z) {
                      if (z == kNoHeight && is_hidden(c, r, hidden_above_, cells_))
                        nearest.offer(grid_point(c, r), metric_.squared(origin_, c, r));
                    });
                  });
    // Cells just outside the grid.
    if (!grid_.wraps) {
      search_rim({-1, -1, 1, grid_.rows + 2}, nearest);
      search_rim({grid_.columns, -1, 1, grid_.rows + 2}, nearest);
    }
    if (!grid_.north_pole) search_rim({0, -1, grid_.columns, 1}, nearest);
    if (!grid_.south_pole) search_rim({0, grid_.rows, grid_.columns, 1}, nearest);
    return nearest.resolve();
  }

  void search_rim(const Window& strip, Nearest& nearest) {
    if (metric_.lower_bound(origin_, strip) > nearest.limit()) return;
    if (strip.cells() <= kReliefBlock) {
      for (std::int64_t r = strip.row; r < strip.end_row(); ++r)
        for (std::int64_t c = strip.column; c < strip.end_column(); ++c)
          nearest.offer(grid_point(c, r), metric_.squared(origin_, c, r));
      return;
    }
    Window first = strip, second = strip;
    if (strip.columns > 1) {
      first.columns = strip.columns / 2;
      second = {first.end_column(), strip.row, strip.columns - first.columns, 1};
    } else {
      first.rows = strip.rows / 2;
      second = {strip.column, first.end_row(), 1, strip.rows - first.rows};
    }
    if (metric_.lower_bound(origin_, second) < metric_.lower_bound(origin_, first)) std::swap(first, second);
    search_rim(first, nearest);
    search_rim(second, nearest);
  }

  struct Queued {
    double bound;
    ReliefPyramid::Block block;
    bool operator<(const Queued& other) const { return bound > other.bound; }  // nearest first
  };

  void search_blocks(auto&& wanted, auto&& limit, auto&& visit) {
    queue_.clear();
    if (wanted(relief_(relief_.top()))) queue_.push_back({0, relief_.top()});
    while (!queue_.empty()) {
      std::ranges::pop_heap(queue_, std::less{});
      const Queued next = queue_.back();
      queue_.pop_back();
      if (next.bound > limit()) return;
      if (next.block.level == 0) {
        visit(relief_.cells(next.block));
        continue;
      }
      for (const auto& [dc, dr] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
        const ReliefPyramid::Block part{next.block.level - 1, 2 * next.block.column + dc,
                                        2 * next.block.row + dr};
        if (!relief_.contains(part) || !wanted(relief_(part))) continue;
        const double bound = metric_.lower_bound(origin_, relief_.cells(part));
        if (bound > limit()) continue;
        queue_.push_back({bound, part});
        std::ranges::push_heap(queue_, std::less{});
      }
    }
  }

  // A block lies in one chunk.
  void for_cells(const Window& block, auto&& visit) {
    const std::int64_t chunk_column = block.column / DemChunks::kSide,
                       chunk_row = block.row / DemChunks::kSide;
    for (std::int64_t r = block.row; r < block.end_row(); ++r)
      for (std::int64_t c = block.column; c < block.end_column(); ++c)
        visit(c, r,
              cells_.chunk(chunk_column, chunk_row)(c - chunk_column * DemChunks::kSide,
                                                    r - chunk_row * DemChunks::kSide));
  }

  const Metric& metric_;
  const GridGeometry& grid_;
  const ReliefPyramid& relief_;
  DemChunks cells_;
  IsolationEnd end_;
  double hidden_above_ = 0;
  std::int64_t column_ = 0, row_ = 0;
  typename Metric::Origin origin_{};
  std::vector<Queued> queue_;
};

static_assert(DemChunks::kSide % kReliefBlock == 0);

// Neighbouring summits need the same chunks, so they are processed chunk by chunk.
std::vector<std::size_t> chunk_order(std::span<const HighPoint> summits, std::int64_t columns) {
  std::vector<std::size_t> order(summits.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t i) {
    const std::int64_t cell = summits[i].cell;
    return std::tuple(cell / columns / DemChunks::kSide, cell % columns / DemChunks::kSide, cell);
  };
  std::ranges::sort(order, {}, key);
  return order;
}

template <class Metric>
std::vector<Isolation> measure_all(std::span<const HighPoint> summits, const DemSource& dem,
                                   const ReliefPyramid& relief, const Metric& metric,
                                   const IsolationOptions& options,
                                   const std::function<void(std::size_t)>& done) {
  std::vector<Isolation> isolations(summits.size());
  const auto order = chunk_order(summits, dem.geometry().columns);
  tbb::enumerable_thread_specific<Search<Metric>> searches(
      [&] { return Search<Metric>(metric, dem, relief, options.end); });
  std::atomic<std::size_t> finished{0};
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, order.size(), 64), [&](const auto& range) {
    Search<Metric>& search = searches.local();
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      isolations[order[i]] = search.measure(summits[order[i]]);
    const std::size_t now = finished += range.size();
    if (done) done(now);
  });
  return isolations;
}

}  // namespace

void check_distance(DistanceKind distance, const GridGeometry& grid) {
  const Crs& crs = grid.where.crs;
  if (distance != DistanceKind::planar || crs.kind() != CrsKind::geographic) return;
  throw Error(ErrorCode::usage,
              "planar isolation needs a projected DEM; this one is in degrees (" + crs.id() + ")",
              "distance = planar",
              "use distance = geodesic, or project the DEM: gdalwarp -t_srs " + fitting_metric_crs(grid));
}

std::vector<Isolation> measure_isolation(std::span<const HighPoint> summits, const DemSource& dem,
                                         const ReliefPyramid& relief, const IsolationOptions& options,
                                         const std::function<void(std::size_t)>& done) {
  const Crs& crs = dem.geometry().where.crs;
  check_distance(options.distance, dem.geometry());
  if (options.distance == DistanceKind::planar || crs.kind() == CrsKind::local)
    return measure_all(summits, dem, relief, PlanarMetric(dem.geometry()), options, done);
  if (crs.kind() == CrsKind::geographic)
    return measure_all(summits, dem, relief, GeographicMetric(dem.geometry()), options, done);
  return measure_all(summits, dem, relief, ProjectedMetric(dem.geometry()), options, done);
}

}  // namespace waymark::pipeline
