// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/sweep_scores.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

namespace waymark::pipeline {
namespace {

constexpr float kNotSeen = std::numeric_limits<float>::quiet_NaN();
constexpr int kSegment = 16;  // steps over which a projection is a parabola, within 0.01 px

// Pixels of a view along the vertical through a node: a parabola in t, which is -1 and 1 at the ends of a
// segment of steps. The level's own pixels.
struct PixelPath {
  float x = kNotSeen, dx = 0, ddx = 0, y = kNotSeen, dy = 0, ddy = 0;

  float sample(const Pixels& image, float t) const {
    return bilinear(image, x + t * (dx + t * ddx), y + t * (dy + t * ddy));
  }
};

PixelPath pixel_path(const PosedCamera& view, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                     double scale) {
  const auto a = project(view, {low}), m = project(view, {0.5 * (low + high)}), b = project(view, {high});
  if (!a || !m || !b) return {};
  const auto level = [&](double pixel) { return (pixel + 0.5) / scale - 0.5; };
  const auto parabola = [&](double p, double q, double r, float& at, float& slope, float& bend) {
    at = static_cast<float>(level(q));
    slope = static_cast<float>((r - p) / 2 / scale);
    bend = static_cast<float>(((r + p) / 2 - q) / scale);
  };
  PixelPath path;
  parabola(a->x(), m->x(), b->x(), path.x, path.dx, path.ddx);
  parabola(a->y(), m->y(), b->y(), path.y, path.dy, path.ddy);
  return path;
}

Eigen::Vector3d node_at(const SweepPass& pass, std::int64_t column, std::int64_t row, double height) {
  return {pass.grid.x(static_cast<double>(column)), pass.grid.y(static_cast<double>(row)), height};
}

// Scores of one block at every step.
class BlockScoring {
 public:
  BlockScoring(const SweepPass& pass, SweepScores& scores) : pass_(pass), scores_(scores) {}

  void score(const SweepBlock& block) {
    const std::vector<LevelView> levels = level_views(block);
    std::vector<double> min_sd;
    for (const LevelView& view : levels) min_sd.push_back(pass_.rules.min_texture * view.image->noise);
    const Window wide{block.nodes.column - kWindowMargin, block.nodes.row - kWindowMargin,
                      block.nodes.columns + 2 * kWindowMargin, block.nodes.rows + 2 * kWindowMargin};
    std::vector<Resampled> seen(levels.size(), Resampled(wide.columns, wide.rows));
    std::vector<std::vector<PixelPath>> paths(levels.size());
    for (int from = 0; from < scores_.steps(); from += kSegment) {
      const int to = std::min(from + kSegment, scores_.steps()) - 1;
      for (std::size_t v = 0; v < levels.size(); ++v)
        paths[v] = segment_paths(pass_.views[block.chosen.views[v]].view, wide, from, to, levels[v].scale);
      for (int k = from; k <= to; ++k) {
        const float t = to > from ? static_cast<float>(2.0 * (k - from) / (to - from) - 1) : 0.0f;
        for (std::size_t v = 0; v < levels.size(); ++v)
          for (std::size_t n = 0; n < paths[v].size(); ++n)
            seen[v].data()[n] = paths[v][n].sample(levels[v].image->pixels, t);
        store(block, k, correlate_windows(seen, min_sd, block.chosen.pairs));
      }
    }
  }

 private:
  struct LevelView {
    std::shared_ptr<const ImageLevel> image;
    double scale = 1;
  };

  std::vector<LevelView> level_views(const SweepBlock& block) const {
    std::vector<LevelView> all;
    const Eigen::Vector3d middle =
        node_at(pass_, block.nodes.column + block.nodes.columns / 2, block.nodes.row + block.nodes.rows / 2,
                base_height(pass_, block.nodes.column + block.nodes.columns / 2,
                            block.nodes.row + block.nodes.rows / 2));
    for (const std::size_t v : block.chosen.views) {
      const int level = level_for(ground_sample_distance(pass_.views[v].view, middle), pass_.grid.cell);
      all.push_back({pass_.images.get(v, level), static_cast<double>(1 << level)});
    }
    return all;
  }

  std::vector<PixelPath> segment_paths(const PosedCamera& view, const Window& wide, int from, int to,
                                       double scale) const {
    std::vector<PixelPath> paths;
    paths.reserve(static_cast<std::size_t>(wide.cells()));
    for (std::int64_t r = wide.row; r < wide.end_row(); ++r)
      for (std::int64_t c = wide.column; c < wide.end_column(); ++c) {
        const double h = base_height(pass_, c, r);
        paths.push_back(pixel_path(view, node_at(pass_, c, r, h + scores_.step_height(from)),
                                   node_at(pass_, c, r, h + scores_.step_height(to)), scale));
      }
    return paths;
  }

  void store(const SweepBlock& block, int k, const WindowScores& scores) {
    std::array<float, 64> values{};
    const std::size_t pairs = scores.pairs.size(), inside = block.chosen.pairs_in_halves;
    for (Eigen::Index j = 0; j < scores.textured.cols(); ++j)
      for (Eigen::Index i = 0; i < scores.textured.rows(); ++i) {
        const std::size_t node = scores_.node(block.nodes.column + i, block.nodes.row + j);
        const std::size_t to = scores_.at(node) + static_cast<std::size_t>(k);
        std::array<float, 2> sum{}, count{};
        for (std::size_t p = 0; p < pairs; ++p) {
          values[p] = scores.pairs[p](i, j);
          if (p >= inside || std::isnan(values[p])) continue;
          const std::size_t half = block.chosen.pairs[p].first % 2;
          sum[half] += values[p];
          count[half] += 1;
        }
        if (count[0] > 0 && count[1] > 0) {
          scores_.first[to] = sum[0] / count[0];
          scores_.second[to] = sum[1] / count[1];
        }
        scores_.all[to] = mean_of_largest(std::span(values).first(pairs), pass_.rules.best_pairs);
        scores_.textured[to] = static_cast<std::uint8_t>(scores.textured(i, j));
        if (k == scores_.half_steps)
          scores_.complete[node] = static_cast<std::uint8_t>(scores.complete(i, j));
      }
  }

  const SweepPass& pass_;
  SweepScores& scores_;
};

}  // namespace

Window clip_to_grid(const Window& window, const SurfaceGrid& grid) {
  const std::int64_t c0 = std::max<std::int64_t>(window.column, 0);
  const std::int64_t r0 = std::max<std::int64_t>(window.row, 0);
  return {c0, r0, std::min(window.end_column(), grid.columns) - c0,
          std::min(window.end_row(), grid.rows) - r0};
}

double base_height(const SweepPass& pass, std::int64_t column, std::int64_t row) {
  return static_cast<double>(pass.base(std::clamp<std::int64_t>(column, 0, pass.grid.columns - 1),
                                       std::clamp<std::int64_t>(row, 0, pass.grid.rows - 1)));
}

SweepScores choose_blocks(const SweepPass& pass, const Window& window) {
  SweepScores made;
  made.window = window;
  made.block.assign(static_cast<std::size_t>(window.cells()), 0);
  for (std::int64_t r = window.row; r < window.end_row(); r += kBlock)
    for (std::int64_t c = window.column; c < window.end_column(); c += kBlock) {
      SweepBlock block{clip_to_grid({c, r, kBlock, kBlock}, pass.grid), {}};
      // The middle of the full block, so that a block cut by the border of the grid chooses alike.
      const std::int64_t mc = std::min(c + kBlock / 2, block.nodes.end_column() - 1);
      const std::int64_t mr = std::min(r + kBlock / 2, block.nodes.end_row() - 1);
      const double height = base_height(pass, mc, mr);
      if (std::isfinite(height))
        block.chosen = choose_views(pass.views, node_at(pass, mc, mr, height), pass.grid.cell, 0,
                                    pass.rules.views, pass.hidden);
      for (std::int64_t j = r; j < block.nodes.end_row(); ++j)
        for (std::int64_t i = c; i < block.nodes.end_column(); ++i)
          made.block[made.node(i, j)] = static_cast<std::uint32_t>(made.blocks.size());
      made.blocks.push_back(std::move(block));
    }
  return made;
}

void fill_scores(const SweepPass& pass, SweepScores& scores) {
  const auto nodes = static_cast<std::size_t>(scores.window.cells());
  scores.all.assign(nodes * static_cast<std::size_t>(scores.steps()), kNotSeen);
  scores.first = scores.second = scores.all;
  scores.textured.assign(scores.all.size(), 0);
  scores.complete.assign(nodes, 0);
  BlockScoring scoring(pass, scores);
  for (const SweepBlock& block : scores.blocks)
    if (!block.chosen.pairs.empty()) scoring.score(block);
}

}  // namespace waymark::pipeline
