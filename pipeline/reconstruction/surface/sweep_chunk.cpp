// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/sweep_chunk.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "pipeline/reconstruction/surface/parabola_vertex.hpp"
#include "pipeline/reconstruction/surface/sweep_scores.hpp"

namespace waymark::pipeline {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr int kMaxSteps = 161;
constexpr double kPeakPixels = 1.5;  // parallax within which a second maximum belongs to the same peak

class ChunkSweep {
 public:
  ChunkSweep(const SweepPass& pass, std::int64_t column, std::int64_t row)
      : pass_(pass),
        core_(clip_to_grid({column, row, kChunk, kChunk}, pass.grid)),
        scores_(choose_blocks(pass, clip_to_grid({column - kChunkHalo, row - kChunkHalo,
                                                  kChunk + 2 * kChunkHalo, kChunk + 2 * kChunkHalo},
                                                 pass.grid))) {}

  ChunkHeights run() {
    std::vector<double> angles;
    for (const SweepBlock& block : scores_.blocks)
      if (!block.chosen.pairs.empty()) angles.push_back(block.chosen.angle);
    if (angles.empty()) return empty();
    std::ranges::sort(angles);
    scores_.step = pass_.rules.step_pixels * pass_.grid.cell / std::tan(angles[angles.size() / 2]);
    scores_.half_steps = pass_.rules.refine_steps;
    if (pass_.half_range > 0) {
      scores_.half_steps =
          std::min(kMaxSteps / 2, static_cast<int>(std::ceil(pass_.half_range / scores_.step)));
      scores_.step = std::max(scores_.step, pass_.half_range / scores_.half_steps);
    }
    fill_scores(pass_, scores_);
    return decide();
  }

 private:
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
        out.block.push_back(scores_.block[scores_.node(c, r)]);
    for (const SweepBlock& block : scores_.blocks) out.blocks.push_back(block.chosen);
    return out;
  }

  std::vector<std::uint16_t> path_costs() const {
    constexpr float kScale = 64, kNeutral = 45;
    CostVolume costs{
        static_cast<int>(scores_.window.columns), static_cast<int>(scores_.window.rows), scores_.steps(), {}};
    costs.cost.resize(scores_.all.size());
    for (std::size_t i = 0; i < costs.cost.size(); ++i) {
      const float score = scores_.all[i];
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
        const std::size_t node = scores_.node(c, r);
        const auto first = costs.begin() + static_cast<std::ptrdiff_t>(scores_.at(node));
        const int best = static_cast<int>(std::min_element(first, first + scores_.steps()) - first);
        out.reason[i] = decide_node(node, best, base_height(pass_, c, r), out, i);
      }
    return out;
  }

  // Height above the base of the best step; `std::nullopt` where it is an end of the range.
  std::optional<double> half_height(const std::vector<float>& scores, std::size_t at) const {
    int top = -1;
    for (int k = 0; k < scores_.steps(); ++k)
      if (!std::isnan(scores[at + static_cast<std::size_t>(k)]) &&
          (top < 0 || scores[at + static_cast<std::size_t>(k)] > scores[at + static_cast<std::size_t>(top)]))
        top = k;
    if (top <= 0 || top >= scores_.steps() - 1) return std::nullopt;
    const auto s = [&](int k) { return scores[at + static_cast<std::size_t>(k)]; };
    return scores_.step_height(top) + scores_.step * parabola_vertex(s(top - 1), s(top), s(top + 1));
  }

  NoHeight decide_node(std::size_t node, int best, double base, ChunkHeights& out, std::size_t i) const {
    const SweepBlock& block = scores_.blocks[scores_.block[node]];
    if (block.chosen.pairs.empty()) return NoHeight::not_seen;
    const SweepRules& rules = pass_.rules;
    const std::size_t at = scores_.at(node);
    const auto score = [&](int k) { return scores_.all[at + static_cast<std::size_t>(k)]; };
    out.height[i] = static_cast<float>(base + scores_.step_height(best));
    out.angle[i] = static_cast<float>(block.chosen.angle);
    out.gsd[i] = static_cast<float>(block.chosen.gsd);
    out.views[i] = scores_.textured[at + static_cast<std::size_t>(best)];
    if (std::isnan(score(best))) return scores_.complete[node] < 2 ? NoHeight::margin : NoHeight::texture;
    // The paths may stop a step beside the peak of the score.
    int top = best;
    for (const int k : {best - 1, best + 1})
      if (k >= 0 && k < scores_.steps() && score(k) > score(top)) top = k;
    out.score[i] = score(top);
    out.views[i] = scores_.textured[at + static_cast<std::size_t>(top)];
    if (top == 0 || top == scores_.steps() - 1) return NoHeight::range_end;
    if (std::isnan(score(top - 1)) || std::isnan(score(top + 1))) return NoHeight::margin;
    const bool peak = score(top) >= score(top - 1) && score(top) >= score(top + 1);
    if (peak)
      out.height[i] =
          static_cast<float>(base + scores_.step_height(top) +
                             scores_.step * parabola_vertex(score(top - 1), score(top), score(top + 1)));
    if (!(static_cast<double>(score(top)) >= rules.min_score)) return NoHeight::low_score;
    if (!peak || second_peak(at, top) > static_cast<double>(score(top)) - rules.min_lead)
      return NoHeight::ambiguous;

    const double bend = (2 * static_cast<double>(score(top)) - static_cast<double>(score(top - 1)) -
                         static_cast<double>(score(top + 1))) /
                        (scores_.step * scores_.step);
    if (!(bend > 0)) return NoHeight::ambiguous;
    const double match =
        rules.match_sd * std::sqrt(std::max(1e-3, 1 - static_cast<double>(score(top))) / bend);
    const double pixel =
        rules.pixel_sd * std::max(pass_.grid.cell, block.chosen.gsd) / std::tan(block.chosen.angle);
    const double sd = std::hypot(match, pixel, rules.relief_sd * pass_.grid.cell);
    out.sd[i] = static_cast<float>(sd);
    const auto a = half_height(scores_.first, at), b = half_height(scores_.second, at);
    if (a && b && std::abs(*a - *b) > rules.max_disagreement * 2 * sd) return NoHeight::disagreement;
    if (sd > rules.max_sd * std::max(pass_.grid.cell, block.chosen.gsd)) return NoHeight::accuracy;
    if (pass_.half_range == 0 &&
        std::abs(static_cast<double>(out.height[i]) - base) > rules.max_jump * std::max(sd, pass_.grid.cell))
      return NoHeight::jump;
    return NoHeight::none;
  }

  double second_peak(std::size_t at, int top) const {
    double second = -1;
    const int apart = static_cast<int>(std::ceil(kPeakPixels / pass_.rules.step_pixels));

    for (int k = 1; k + 1 < scores_.steps(); ++k) {
      if (std::abs(k - top) < apart) continue;
      const float s = scores_.all[at + static_cast<std::size_t>(k)];
      if (s >= scores_.all[at + static_cast<std::size_t>(k - 1)] &&
          s >= scores_.all[at + static_cast<std::size_t>(k + 1)])
        second = std::max(second, static_cast<double>(s));
    }
    return second;
  }

  const SweepPass& pass_;
  Window core_;
  SweepScores scores_;
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
