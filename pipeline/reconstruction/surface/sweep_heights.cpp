// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/sweep_heights.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>

#include "pipeline/reconstruction/surface/height_checks.hpp"
#include "pipeline/reconstruction/surface/pose_uncertainty.hpp"
#include "pipeline/reconstruction/surface/sweep_scores.hpp"

namespace waymark::pipeline {
namespace {

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();
constexpr double kUsualTangent = 0.4;  // of 22 degrees, to plan the number of passes
constexpr int kMaxLevels = 6;
constexpr std::int64_t kMinNodes = 12;   // across the coarsest pass
constexpr std::int64_t kMaxIsland = 25;  // cells
constexpr double kJumpLimit = 4;         // robust standard deviations

struct UsedViews {
  std::vector<std::size_t> views;
  double angle = 0;  // largest between two that are compared, radians
  double gsd = 0;    // coarsest, metres
  Eigen::Matrix3d systematic = Eigen::Matrix3d::Zero();
};

class HeightSweep {
 public:
  HeightSweep(const std::vector<SurfaceView>& views, const SweepPlan& plan)
      : views_(views), plan_(plan), images_(views, plan.image_bytes), node_(plan.grid.cell / 2) {}

  SurfaceHeights run() {
    const int levels = level_count();
    SurfaceGrid grid = level_grid(levels);
    Grid<float> base = first_base(grid);
    double half_range = first_half_range(grid);
    for (int l = levels; l >= 0; --l)
      work_ += static_cast<double>(level_grid(l).columns * level_grid(l).rows);

    std::optional<Terrain> relief;
    for (int l = levels; l > 0; --l) {
      const Grid<float> found = coarse_pass(l, grid, base, half_range, relief);
      if (std::ranges::any_of(found.cells(), [](float h) { return !std::isnan(h); })) base = smoothed(found);
      relief = grid.columns > 1 && grid.rows > 1 ? std::optional(terrain_of(base, grid)) : std::nullopt;
      const SurfaceGrid finer = level_grid(l - 1);
      base = resample(base, grid, finer);
      grid = finer;
      half_range = 0;
    }
    return finest_pass(grid, base, half_range, relief);
  }

 private:
  SurfaceGrid level_grid(int level) const {
    return plan_.grid.with_cell(node_ * static_cast<double>(1 << level));
  }

  int level_count() const {
    int levels = std::min(plan_.levels, kMaxLevels);
    const auto nodes = [&](int l) { return std::min(level_grid(l).columns, level_grid(l).rows); };
    while (levels < kMaxLevels && nodes(levels + 1) >= kMinNodes &&
           first_half_range(level_grid(levels)) > 80 * first_step(level_grid(levels)))
      ++levels;
    while (levels > 0 && nodes(levels) < kMinNodes) --levels;
    return levels;
  }

  double first_step(const SurfaceGrid& grid) const {
    return plan_.rules.step_pixels * grid.cell / kUsualTangent;
  }

  double first_half_range(const SurfaceGrid& grid) const {
    const double min_range = 4 * first_step(grid);
    if (plan_.coarse) return std::max(4 * plan_.coarse->sd, min_range);
    return std::max((plan_.range.high - plan_.range.low) / 2, min_range);
  }

  Grid<float> first_base(const SurfaceGrid& grid) const {
    const auto middle = static_cast<float>((plan_.range.low + plan_.range.high) / 2);
    Grid<float> base(grid.columns, grid.rows, middle);
    if (!plan_.coarse) return base;
    base = fill_gaps(resample(plan_.coarse->heights, plan_.coarse->grid, grid));
    for (float& height : base.cells())
      if (std::isnan(height)) height = middle;
    return base;
  }

  static Grid<float> smoothed(const Grid<float>& heights) {
    const Grid<float> robust = median_filter(median_filter(fill_gaps(heights)));
    Grid<float> mean = robust;
    for (std::int64_t r = 0; r < mean.rows(); ++r)
      for (std::int64_t c = 0; c < mean.columns(); ++c) {
        double sum = 0;
        int count = 0;
        for (std::int64_t j = -1; j <= 1; ++j)
          for (std::int64_t i = -1; i <= 1; ++i)
            if (robust.contains(c + i, r + j)) sum += static_cast<double>(robust(c + i, r + j)), ++count;
        mean(c, r) = static_cast<float>(sum / count);
      }
    return mean;
  }

  SweepPass pass_of(const SurfaceGrid& grid, const Grid<float>& base, double half_range,
                    const std::optional<Terrain>& relief) {
    HiddenTest hidden;
    if (relief)
      hidden = [this, &relief, lift = 2 * relief->step_x()](std::size_t v, const Eigen::Vector3d& point) {
        return hides(*relief, v, point, lift);
      };
    return {.views = views_,
            .images = images_,
            .rules = plan_.rules,
            .grid = grid,
            .base = base,
            .hidden = std::move(hidden),
            .half_range = half_range};
  }

  bool hides(const Terrain& relief, std::size_t v, const Eigen::Vector3d& point, double lift) const {
    const Eigen::Vector3d raised = point + Eigen::Vector3d(0, 0, lift);
    const Eigen::Vector3d towards = views_[v].view.centre().xyz - raised;
    return towards.norm() > 0 && relief.in_shadow({raised}, {towards.normalized()});
  }

  // Calls `use` for every chunk; each writes its own cells.
  template <class Use>
  void for_chunks(int level, const SweepPass& pass, const Use& use) {
    const std::int64_t across = (pass.grid.columns + kChunk - 1) / kChunk,
                       down = (pass.grid.rows + kChunk - 1) / kChunk;
    tbb::parallel_for(std::int64_t{0}, across * down, [&](std::int64_t n) {
      const auto sweep = [&] { return sweep_chunk(pass, n % across * kChunk, n / across * kChunk); };
      const ChunkHeights chunk =
          plan_.keep ? plan_.keep(fmt::format("pass_{}_chunk_{:06}", level, n), sweep) : sweep();
      use(chunk);
      const std::lock_guard lock(mutex_);
      done_ += static_cast<double>(chunk.window.cells());
      if (plan_.progress) plan_.progress(std::min(1.0, done_ / work_));
    });
  }

  // Heights of one pass for the next; NaN where they say too little.
  Grid<float> coarse_pass(int level, const SurfaceGrid& grid, const Grid<float>& base, double half_range,
                          const std::optional<Terrain>& relief) {
    Grid<float> heights(grid.columns, grid.rows, kNoValue);
    for_chunks(level, pass_of(grid, base, half_range, relief), [&](const ChunkHeights& chunk) {
      for (std::size_t i = 0; i < chunk.height.size(); ++i) {
        const NoHeight reason = chunk.reason[i];
        if (reason != NoHeight::none && reason != NoHeight::accuracy && reason != NoHeight::disagreement)
          continue;
        const auto n = static_cast<std::int64_t>(i);
        heights(chunk.window.column + n % chunk.window.columns, chunk.window.row + n / chunk.window.columns) =
            chunk.height[i];
      }
    });
    return heights;
  }

  SurfaceHeights finest_pass(const SurfaceGrid& grid, const Grid<float>& base, double half_range,
                             const std::optional<Terrain>& relief) {
    const std::int64_t columns = plan_.grid.columns, rows = plan_.grid.rows;
    const Grid<float> unknown(columns, rows, kNoValue);
    const Grid<std::uint8_t> zero(columns, rows, 0);
    out_ = {.grid = plan_.grid,
            .height = unknown,
            .sd = unknown,
            .systematic_sd = unknown,
            .angle = unknown,
            .score = unknown,
            .views = zero,
            .reason = zero};
    const std::int64_t blocks = blocks_across();
    used_.assign(static_cast<std::size_t>(blocks * ((grid.rows + kBlock - 1) / kBlock)), {});
    for_chunks(0, pass_of(grid, base, half_range, relief),
               [&](const ChunkHeights& chunk) { join_nodes(chunk, base); });
    drop_hidden();
    drop_where(cells_off_plane(out_.height, out_.sd, kJumpLimit), NoHeight::jump);
    refine();
    drop_where(cells_of_islands(out_.height, kMaxIsland, 3 * plan_.grid.cell), NoHeight::island);
    add_systematic();
    for (const std::uint8_t reason : out_.reason.cells()) ++out_.counts[reason];
    return std::move(out_);
  }

  std::int64_t blocks_across() const { return (level_grid(0).columns + kBlock - 1) / kBlock; }
  UsedViews& used(std::int64_t column, std::int64_t row) {
    return used_[static_cast<std::size_t>(2 * row / kBlock * blocks_across() + 2 * column / kBlock)];
  }

  void join_nodes(const ChunkHeights& chunk, const Grid<float>& base) {
    const Window& w = chunk.window;
    for (std::int64_t r = w.row; r + 1 < w.end_row(); r += 2)
      for (std::int64_t c = w.column; c + 1 < w.end_column(); c += 2) {
        const auto node = [&](std::int64_t i, std::int64_t j) {
          return static_cast<std::size_t>((r + j - w.row) * w.columns + c + i - w.column);
        };
        join_cell(chunk, {node(0, 0), node(1, 0), node(0, 1), node(1, 1)}, c / 2, r / 2);
        UsedViews& block = used(c / 2, r / 2);
        if (c % kBlock != 0 || r % kBlock != 0) continue;
        block.views = chunk.blocks[chunk.block[node(0, 0)]].views;
        block.angle = chunk.blocks[chunk.block[node(0, 0)]].angle;
        block.gsd = chunk.blocks[chunk.block[node(0, 0)]].gsd;
        const std::int64_t mc = std::min(c + kBlock / 2, w.end_column() - 1),
                           mr = std::min(r + kBlock / 2, w.end_row() - 1);
        const SurfaceGrid grid = level_grid(0);
        const Eigen::Vector3d middle(grid.x(double(mc)), grid.y(double(mr)),
                                     static_cast<double>(base(mc, mr)));
        if (const auto covariance = pose_uncertainty(views_, block.views, middle))
          block.systematic = *covariance;
      }
  }

  // The mean of the nodes measured, if there are two; else the most frequent reason, the first of equals.
  void join_cell(const ChunkHeights& chunk, const std::array<std::size_t, 4>& nodes, std::int64_t c,
                 std::int64_t r) {
    std::array<int, kNoHeightReasons> count{};
    double height = 0, sd = 0, score = 0, angle = 0;
    int views = 255;
    for (const std::size_t n : nodes) {
      ++count[static_cast<std::size_t>(chunk.reason[n])];
      if (chunk.reason[n] != NoHeight::none) continue;
      height += static_cast<double>(chunk.height[n]);
      sd += static_cast<double>(chunk.sd[n]);
      score += static_cast<double>(chunk.score[n]);
      angle += static_cast<double>(chunk.angle[n]);
      views = std::min(views, static_cast<int>(chunk.views[n]));
    }
    const int known = count[0];
    if (known < 2) {
      out_.reason(c, r) =
          static_cast<std::uint8_t>(std::max_element(count.begin() + 1, count.end()) - count.begin());
      return;
    }
    out_.height(c, r) = static_cast<float>(height / known);
    out_.sd(c, r) = static_cast<float>(sd / known);
    out_.score(c, r) = static_cast<float>(score / known);
    out_.angle(c, r) = static_cast<float>(angle / known * 180 / std::numbers::pi);
    out_.views(c, r) = static_cast<std::uint8_t>(views);
  }

  void drop(std::int64_t c, std::int64_t r, NoHeight reason) {
    out_.height(c, r) = out_.sd(c, r) = out_.score(c, r) = out_.angle(c, r) = kNoValue;
    out_.views(c, r) = 0;
    out_.reason(c, r) = static_cast<std::uint8_t>(reason);
  }
  void drop_where(const Grid<std::uint8_t>& marks, NoHeight reason) {
    for (std::int64_t r = 0; r < marks.rows(); ++r)
      for (std::int64_t c = 0; c < marks.columns(); ++c)
        if (marks(c, r) && out_.reason(c, r) == 0) drop(c, r, reason);
  }

  // Drops the cells that the DEM itself hides from all but one of the views used.
  void drop_hidden() {
    if (plan_.grid.columns < 2 || plan_.grid.rows < 2 || out_.height.cells().empty()) return;
    const Terrain relief = terrain_of(median_filter(out_.height), plan_.grid);
    Grid<std::uint8_t> hidden(plan_.grid.columns, plan_.grid.rows, 0);
    tbb::parallel_for(std::int64_t{0}, plan_.grid.rows, [&](std::int64_t r) {
      for (std::int64_t c = 0; c < plan_.grid.columns; ++c) {
        if (out_.reason(c, r) != 0) continue;
        const Eigen::Vector3d point(plan_.grid.x(double(c)), plan_.grid.y(double(r)),
                                    static_cast<double>(out_.height(c, r)));
        const double lift = plan_.grid.cell + 3 * static_cast<double>(out_.sd(c, r));
        int free = 0;
        for (const std::size_t v : used(c, r).views) {
          free += hides(relief, v, point, lift) ? 0 : 1;
          if (free >= 2) break;
        }
        hidden(c, r) = free < 2;
      }
    });
    drop_where(hidden, NoHeight::hidden);
  }

  // Cells whose standard deviation stays too large are dropped.
  void refine() {
    constexpr std::int64_t kTile = kChunk / 2, kCellBlock = kBlock / 2;
    const std::int64_t across = (plan_.grid.columns + kTile - 1) / kTile,
                       down = (plan_.grid.rows + kTile - 1) / kTile;
    const Grid<float> heights = out_.height, sd = out_.sd;
    const ViewsAt views = [this](std::int64_t c, std::int64_t r) {
      const UsedViews& block = used(c, r);
      return ComparedViews{views_, images_, block.views, block.angle};
    };
    tbb::parallel_for(std::int64_t{0}, across * down, [&](std::int64_t n) {
      const Window tile = clip_to_grid({n % across * kTile, n / across * kTile, kTile, kTile}, plan_.grid);
      const std::vector<RefinedHeight> refined =
          refine_heights(heights, sd, plan_.grid, tile, kCellBlock, views, plan_.rules.refine);
      for (std::int64_t i = 0; i < tile.cells(); ++i) {
        const std::int64_t c = tile.column + i % tile.columns, r = tile.row + i / tile.columns;
        if (out_.reason(c, r) != 0) continue;
        const RefinedHeight& cell = refined[static_cast<std::size_t>(i)];
        out_.height(c, r) = cell.height;
        out_.sd(c, r) = cell.sd;
        if (!(static_cast<double>(cell.sd) <= plan_.rules.max_refined_sd * std::max(node_, used(c, r).gsd)))
          drop(c, r, NoHeight::accuracy);
      }
    });
  }

  // Height error at a cell: that of the point, less what its horizontal error does on the slope.
  void add_systematic() {
    const Grid<float> filled = smoothed(out_.height);
    for (std::int64_t r = 0; r < plan_.grid.rows; ++r)
      for (std::int64_t c = 0; c < plan_.grid.columns; ++c) {
        if (out_.reason(c, r) != 0) continue;
        const std::int64_t w = std::max<std::int64_t>(c - 1, 0), e = std::min(c + 1, plan_.grid.columns - 1);
        const std::int64_t n = std::max<std::int64_t>(r - 1, 0), s = std::min(r + 1, plan_.grid.rows - 1);
        const auto h = [&](std::int64_t i, std::int64_t j) { return static_cast<double>(filled(i, j)); };
        const double dx = (h(e, r) - h(w, r)) / (double(std::max<std::int64_t>(e - w, 1)) * plan_.grid.cell);
        const double dy = (h(c, n) - h(c, s)) / (double(std::max<std::int64_t>(s - n, 1)) * plan_.grid.cell);
        const Eigen::Vector3d direction(-dx, -dy, 1);
        out_.systematic_sd(c, r) =
            static_cast<float>(std::sqrt(std::max(0.0, direction.dot(used(c, r).systematic * direction))));
      }
  }

  const std::vector<SurfaceView>& views_;
  const SweepPlan& plan_;
  ImageLevels images_;
  double node_;
  SurfaceHeights out_;
  std::vector<UsedViews> used_;
  std::mutex mutex_;
  double work_ = 0, done_ = 0;
};

}  // namespace

SurfaceHeights sweep_heights(const std::vector<SurfaceView>& views, const SweepPlan& plan) {
  return HeightSweep(views, plan).run();
}

}  // namespace waymark::pipeline
