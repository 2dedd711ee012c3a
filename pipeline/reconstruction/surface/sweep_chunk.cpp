// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/sweep_chunk.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

namespace waymark::pipeline {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr int kMaxSteps = 161;
constexpr double kPeakPixels = 1.5;  // parallax within which a second maximum belongs to the same peak
constexpr int kSegment = 16;         // steps over which a projection is a parabola, within 0.01 px

struct Block {
  Window nodes;  ///< of the grid
  ChosenViews chosen;
};

// Scores of a chunk with its halo; steps fastest, then columns.
struct ScoreVolume {
  Window window;
  int steps = 0;
  std::vector<float> all, first, second;  ///< all pairs; pairs of either half
  std::vector<std::uint8_t> textured;     ///< views, by step
  std::vector<std::uint8_t> complete;     ///< views, by node
  std::vector<std::uint32_t> block;       ///< of each node

  std::size_t node(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>((row - window.row) * window.columns + column - window.column);
  }
  std::size_t at(std::size_t node) const { return node * static_cast<std::size_t>(steps); }
};

float bilinear(const Pixels& image, float x, float y) {
  const auto right = static_cast<float>(image.columns() - 1), bottom = static_cast<float>(image.rows() - 1);
  if (!(x >= 0 && y >= 0 && x <= right && y <= bottom)) return kUnknown;
  const auto i = std::min(static_cast<std::int64_t>(x), image.columns() - 2);
  const auto j = std::min(static_cast<std::int64_t>(y), image.rows() - 2);
  const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
  const float upper = image(i, j) + a * (image(i + 1, j) - image(i, j));
  const float lower = image(i, j + 1) + a * (image(i + 1, j + 1) - image(i, j + 1));
  return upper + b * (lower - upper);
}

// Pixels of a view along the vertical through a node: a parabola in t, which is -1 and 1 at the ends of a
// segment of steps. The level's own pixels.
struct PixelPath {
  float x = kUnknown, dx = 0, ddx = 0, y = kUnknown, dy = 0, ddy = 0;

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

class ChunkSweep {
 public:
  ChunkSweep(const SweepPass& pass, std::int64_t column, std::int64_t row) : pass_(pass) {
    core_ = clipped({column, row, kChunk, kChunk});
    volume_.window =
        clipped({column - kChunkHalo, row - kChunkHalo, kChunk + 2 * kChunkHalo, kChunk + 2 * kChunkHalo});
  }

  ChunkHeights run() {
    choose_blocks();
    std::vector<double> angles;
    for (const Block& block : blocks_)
      if (!block.chosen.pairs.empty()) angles.push_back(block.chosen.angle);
    if (angles.empty()) return empty();
    std::ranges::sort(angles);
    step_ = pass_.rules.step_pixels * pass_.grid.cell / std::tan(angles[angles.size() / 2]);
    half_steps_ = pass_.rules.refine_steps;
    if (pass_.half_range > 0) {
      half_steps_ = std::min(kMaxSteps / 2, static_cast<int>(std::ceil(pass_.half_range / step_)));
      step_ = std::max(step_, pass_.half_range / half_steps_);
    }
    fill_scores();
    return decide();
  }

 private:
  Window clipped(Window w) const {
    const std::int64_t c0 = std::max<std::int64_t>(w.column, 0), r0 = std::max<std::int64_t>(w.row, 0);
    return {c0, r0, std::min(w.end_column(), pass_.grid.columns) - c0,
            std::min(w.end_row(), pass_.grid.rows) - r0};
  }

  double base(std::int64_t column, std::int64_t row) const {
    return static_cast<double>(pass_.base(std::clamp<std::int64_t>(column, 0, pass_.grid.columns - 1),
                                          std::clamp<std::int64_t>(row, 0, pass_.grid.rows - 1)));
  }
  Eigen::Vector3d point(std::int64_t column, std::int64_t row, double height) const {
    return {pass_.grid.x(static_cast<double>(column)), pass_.grid.y(static_cast<double>(row)), height};
  }
  double step_height(int k) const { return (k - half_steps_) * step_; }

  void choose_blocks() {
    const Window& w = volume_.window;
    volume_.block.assign(static_cast<std::size_t>(w.cells()), 0);
    for (std::int64_t r = w.row; r < w.end_row(); r += kBlock)
      for (std::int64_t c = w.column; c < w.end_column(); c += kBlock) {
        Block block{clipped({c, r, kBlock, kBlock}), {}};
        // The middle of the full block, so that a block cut by the border of the grid chooses alike.
        const std::int64_t mc = std::min(c + kBlock / 2, block.nodes.end_column() - 1);
        const std::int64_t mr = std::min(r + kBlock / 2, block.nodes.end_row() - 1);
        const double height = base(mc, mr);
        if (std::isfinite(height))
          block.chosen = choose_views(pass_.views, point(mc, mr, height), pass_.grid.cell, 0,
                                      pass_.rules.views, pass_.hidden);
        for (std::int64_t j = r; j < block.nodes.end_row(); ++j)
          for (std::int64_t i = c; i < block.nodes.end_column(); ++i)
            volume_.block[volume_.node(i, j)] = static_cast<std::uint32_t>(blocks_.size());
        blocks_.push_back(std::move(block));
      }
  }

  ChunkHeights empty() const {
    const auto count = static_cast<std::size_t>(core_.cells());
    const std::vector<float> unknown(count, kUnknown);
    ChunkHeights out{.window = core_,
                     .height = unknown,
                     .sd = unknown,
                     .score = unknown,
                     .angle = unknown,
                     .gsd = unknown,
                     .views = std::vector<std::uint8_t>(count, 0),
                     .reason = std::vector<NoHeight>(count, NoHeight::not_seen),
                     .block = {},
                     .blocks = {}};
    for (std::int64_t r = core_.row; r < core_.end_row(); ++r)
      for (std::int64_t c = core_.column; c < core_.end_column(); ++c)
        out.block.push_back(volume_.block[volume_.node(c, r)]);
    for (const Block& block : blocks_) out.blocks.push_back(block.chosen);
    return out;
  }

  void fill_scores() {
    volume_.steps = 2 * half_steps_ + 1;
    const auto nodes = static_cast<std::size_t>(volume_.window.cells());
    volume_.all.assign(nodes * static_cast<std::size_t>(volume_.steps), kUnknown);
    volume_.first = volume_.second = volume_.all;
    volume_.textured.assign(volume_.all.size(), 0);
    volume_.complete.assign(nodes, 0);
    for (const Block& block : blocks_)
      if (!block.chosen.pairs.empty()) score_block(block);
  }

  struct LevelView {
    std::shared_ptr<const ImageLevel> image;
    double scale = 1;
  };

  std::vector<LevelView> level_views(const Block& block) const {
    std::vector<LevelView> all;
    const Eigen::Vector3d middle =
        point(block.nodes.column + block.nodes.columns / 2, block.nodes.row + block.nodes.rows / 2,
              base(block.nodes.column + block.nodes.columns / 2, block.nodes.row + block.nodes.rows / 2));
    for (const std::size_t v : block.chosen.views) {
      const double gsd = ground_sample_distance(pass_.views[v].view, middle);
      const int level = std::clamp(static_cast<int>(std::lround(std::log2(pass_.grid.cell / gsd))), 0, 8);
      all.push_back({pass_.images.get(v, level), static_cast<double>(1 << level)});
    }
    return all;
  }

  void score_block(const Block& block) {
    const std::vector<LevelView> levels = level_views(block);
    std::vector<double> min_sd;
    for (const LevelView& view : levels) min_sd.push_back(pass_.rules.min_texture * view.image->noise);
    const Window wide{block.nodes.column - kWindowMargin, block.nodes.row - kWindowMargin,
                      block.nodes.columns + 2 * kWindowMargin, block.nodes.rows + 2 * kWindowMargin};
    std::vector<Resampled> seen(levels.size(), Resampled(wide.columns, wide.rows));
    std::vector<std::vector<PixelPath>> paths(levels.size());
    for (int from = 0; from < volume_.steps; from += kSegment) {
      const int to = std::min(from + kSegment, volume_.steps) - 1;
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

  std::vector<PixelPath> segment_paths(const PosedCamera& view, const Window& wide, int from, int to,
                                       double scale) const {
    std::vector<PixelPath> paths;
    paths.reserve(static_cast<std::size_t>(wide.cells()));
    for (std::int64_t r = wide.row; r < wide.end_row(); ++r)
      for (std::int64_t c = wide.column; c < wide.end_column(); ++c) {
        const double h = base(c, r);
        paths.push_back(
            pixel_path(view, point(c, r, h + step_height(from)), point(c, r, h + step_height(to)), scale));
      }
    return paths;
  }

  void store(const Block& block, int k, const WindowScores& scores) {
    std::array<float, 64> values{};
    const std::size_t pairs = scores.pairs.size(), inside = block.chosen.pairs_in_halves;
    for (Eigen::Index j = 0; j < scores.textured.cols(); ++j)
      for (Eigen::Index i = 0; i < scores.textured.rows(); ++i) {
        const std::size_t node = volume_.node(block.nodes.column + i, block.nodes.row + j);
        const std::size_t to = volume_.at(node) + static_cast<std::size_t>(k);
        std::array<float, 2> sum{}, count{};
        for (std::size_t p = 0; p < pairs; ++p) {
          values[p] = scores.pairs[p](i, j);
          if (p >= inside || std::isnan(values[p])) continue;
          const std::size_t half = block.chosen.pairs[p].first % 2;
          sum[half] += values[p];
          count[half] += 1;
        }
        if (count[0] > 0 && count[1] > 0) {
          volume_.first[to] = sum[0] / count[0];
          volume_.second[to] = sum[1] / count[1];
        }
        volume_.all[to] = mean_of_largest(std::span(values).first(pairs), pass_.rules.best_pairs);
        volume_.textured[to] = static_cast<std::uint8_t>(scores.textured(i, j));
        if (k == half_steps_) volume_.complete[node] = static_cast<std::uint8_t>(scores.complete(i, j));
      }
  }

  std::vector<std::uint16_t> path_costs() const {
    constexpr float kScale = 64, kNeutral = 45;
    CostVolume costs{
        static_cast<int>(volume_.window.columns), static_cast<int>(volume_.window.rows), volume_.steps, {}};
    costs.cost.resize(volume_.all.size());
    for (std::size_t i = 0; i < costs.cost.size(); ++i) {
      const float score = volume_.all[i];
      costs.cost[i] = static_cast<std::uint8_t>(
          std::isnan(score) ? kNeutral : std::clamp(std::round(kScale * (1 - score)), 0.0f, 127.0f));
    }
    return sum_path_costs(costs, pass_.rules.penalties);
  }

  ChunkHeights decide() const {
    const std::vector<std::uint16_t> costs = path_costs();
    ChunkHeights out = empty();
    std::size_t i = 0;
    for (std::int64_t r = core_.row; r < core_.end_row(); ++r)
      for (std::int64_t c = core_.column; c < core_.end_column(); ++c, ++i) {
        const std::size_t node = volume_.node(c, r);
        const auto first = costs.begin() + static_cast<std::ptrdiff_t>(volume_.at(node));
        const int best = static_cast<int>(std::min_element(first, first + volume_.steps) - first);
        out.reason[i] = decide_node(node, best, base(c, r), out, i);
      }
    return out;
  }

  // Vertex of the parabola through three scores, in steps from the middle one; 0 without a maximum.
  static double vertex(float left, float middle, float right) {
    const double bend =
        static_cast<double>(left) - 2 * static_cast<double>(middle) + static_cast<double>(right);
    if (!(bend < 0)) return 0;
    return std::clamp(0.5 * (static_cast<double>(left) - static_cast<double>(right)) / bend, -0.5, 0.5);
  }

  // Height above the base of the best step; `std::nullopt` where it is an end of the range.
  std::optional<double> half_height(const std::vector<float>& scores, std::size_t at) const {
    int top = -1;
    for (int k = 0; k < volume_.steps; ++k)
      if (!std::isnan(scores[at + static_cast<std::size_t>(k)]) &&
          (top < 0 || scores[at + static_cast<std::size_t>(k)] > scores[at + static_cast<std::size_t>(top)]))
        top = k;
    if (top <= 0 || top >= volume_.steps - 1) return std::nullopt;
    const auto s = [&](int k) { return scores[at + static_cast<std::size_t>(k)]; };
    return step_height(top) + step_ * vertex(s(top - 1), s(top), s(top + 1));
  }

  NoHeight decide_node(std::size_t node, int best, double base_height, ChunkHeights& out,
                       std::size_t i) const {
    const Block& block = blocks_[volume_.block[node]];
    if (block.chosen.pairs.empty()) return NoHeight::not_seen;
    const SweepRules& rules = pass_.rules;
    const std::size_t at = volume_.at(node);
    const auto score = [&](int k) { return volume_.all[at + static_cast<std::size_t>(k)]; };
    out.height[i] = static_cast<float>(base_height + step_height(best));
    out.angle[i] = static_cast<float>(block.chosen.angle);
    out.gsd[i] = static_cast<float>(block.chosen.gsd);
    out.views[i] = volume_.textured[at + static_cast<std::size_t>(best)];
    if (std::isnan(score(best))) return volume_.complete[node] < 2 ? NoHeight::margin : NoHeight::texture;
    // The paths may stop a step beside the peak of the score.
    int top = best;
    for (const int k : {best - 1, best + 1})
      if (k >= 0 && k < volume_.steps && score(k) > score(top)) top = k;
    out.score[i] = score(top);
    out.views[i] = volume_.textured[at + static_cast<std::size_t>(top)];
    if (top == 0 || top == volume_.steps - 1) return NoHeight::range_end;
    if (std::isnan(score(top - 1)) || std::isnan(score(top + 1))) return NoHeight::margin;
    const bool peak = score(top) >= score(top - 1) && score(top) >= score(top + 1);
    if (peak)
      out.height[i] = static_cast<float>(base_height + step_height(top) +
                                         step_ * vertex(score(top - 1), score(top), score(top + 1)));
    if (!(static_cast<double>(score(top)) >= rules.min_score)) return NoHeight::low_score;
    if (!peak || second_peak(at, top) > static_cast<double>(score(top)) - rules.min_lead)
      return NoHeight::ambiguous;

    const double bend = (2 * static_cast<double>(score(top)) - static_cast<double>(score(top - 1)) -
                         static_cast<double>(score(top + 1))) /
                        (step_ * step_);
    if (!(bend > 0)) return NoHeight::ambiguous;
    const double match =
        rules.match_sd * std::sqrt(std::max(1e-3, 1 - static_cast<double>(score(top))) / bend);
    const double pixel =
        rules.pixel_sd * std::max(pass_.grid.cell, block.chosen.gsd) / std::tan(block.chosen.angle);
    const double sd = std::hypot(match, pixel, rules.relief_sd * pass_.grid.cell);
    out.sd[i] = static_cast<float>(sd);
    const auto a = half_height(volume_.first, at), b = half_height(volume_.second, at);
    if (a && b && std::abs(*a - *b) > rules.max_disagreement * 2 * sd) return NoHeight::disagreement;
    if (sd > rules.max_sd * std::max(pass_.grid.cell, block.chosen.gsd)) return NoHeight::accuracy;
    if (pass_.half_range == 0 && std::abs(static_cast<double>(out.height[i]) - base_height) >
                                     rules.max_jump * std::max(sd, pass_.grid.cell))
      return NoHeight::jump;
    return NoHeight::none;
  }

  double second_peak(std::size_t at, int top) const {
    double second = -1;
    const int apart = static_cast<int>(std::ceil(kPeakPixels / pass_.rules.step_pixels));

    for (int k = 1; k + 1 < volume_.steps; ++k) {
      if (std::abs(k - top) < apart) continue;
      const float s = volume_.all[at + static_cast<std::size_t>(k)];
      if (s >= volume_.all[at + static_cast<std::size_t>(k - 1)] &&
          s >= volume_.all[at + static_cast<std::size_t>(k + 1)])
        second = std::max(second, static_cast<double>(s));
    }
    return second;
  }

  const SweepPass& pass_;
  Window core_;
  ScoreVolume volume_;
  std::vector<Block> blocks_;
  double step_ = 0;
  int half_steps_ = 0;
};

}  // namespace

const char* reason_text(NoHeight reason) {
  static constexpr std::array<const char*, kNoHeightReasons> kTexts{"measured",
                                                                    "fewer than two comparable views",
                                                                    "window beyond the images",
                                                                    "texture below noise",
                                                                    "images differ",
                                                                    "second height fits as well",
                                                                    "at the end of the search",
                                                                    "halves of the views disagree",
                                                                    "expected error too large",
                                                                    "hidden from the views",
                                                                    "off the plane of its neighbours",
                                                                    "small island"};
  return kTexts[static_cast<std::size_t>(reason)];
}

ChunkHeights sweep_chunk(const SweepPass& pass, std::int64_t column, std::int64_t row) {
  return ChunkSweep(pass, column, row).run();
}

}  // namespace waymark::pipeline
