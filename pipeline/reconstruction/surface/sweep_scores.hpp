// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "pipeline/reconstruction/surface/sweep_chunk.hpp"
namespace waymark::pipeline {

/// Square of nodes that are seen by the same views.
struct SweepBlock {
  Window nodes;  ///< of the grid
  ChosenViews chosen;
};

/// Scores of the nodes of a window at each step of height; steps fastest, then columns.
struct SweepScores {
  Window window;
  std::vector<SweepBlock> blocks;
  std::vector<std::uint32_t> block;       ///< index into `blocks`, by node
  double step = 0;                        ///< metres
  int half_steps = 0;                     ///< on each side of the base
  std::vector<float> all, first, second;  ///< of all pairs; of the pairs of either half
  std::vector<std::uint8_t> textured;     ///< views, by step
  std::vector<std::uint8_t> complete;     ///< views, by node

  int steps() const { return 2 * half_steps + 1; }
  double step_height(int k) const { return (k - half_steps) * step; }
  std::size_t node(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>((row - window.row) * window.columns + column - window.column);
  }
  std::size_t at(std::size_t node) const { return node * static_cast<std::size_t>(steps()); }
};

/// Returns the part of a window that lies in the grid.
Window clip_to_grid(const Window& window, const SurfaceGrid& grid);

/// Returns the height about which a node is searched; nodes beyond the grid have that of its border.
double base_height(const SweepPass& pass, std::int64_t column, std::int64_t row);

/// Cuts a window of the grid into blocks and chooses their views. Nothing is scored.
SweepScores choose_blocks(const SweepPass& pass, const Window& window);

/// Scores every node of the blocks that have pairs of views, at the steps that `scores` names.
void fill_scores(const SweepPass& pass, SweepScores& scores);

}  // namespace waymark::pipeline
