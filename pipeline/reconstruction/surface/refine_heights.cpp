// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/refine_heights.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::pipeline {
namespace {

Grid<float> part_of(const Grid<float>& from, const Window& w) {
  Grid<float> out(w.columns, w.rows);
  for (std::int64_t r = 0; r < w.rows; ++r)
    for (std::int64_t c = 0; c < w.columns; ++c) out(c, r) = from(w.column + c, w.row + r);
  return out;
}

Window widened(const Window& w, std::int64_t by, const Grid<float>& grid) {
  const std::int64_t c0 = std::max<std::int64_t>(w.column - by, 0),
                     r0 = std::max<std::int64_t>(w.row - by, 0);
  return {c0, r0, std::min(w.end_column() + by, grid.columns()) - c0,
          std::min(w.end_row() + by, grid.rows()) - r0};
}

// Nodes of a cell lie a quarter of it from its centre: bilinear among the known of four cells.
NodeSurface nodes_of(const Grid<float>& heights, const Window& cells, const SurfaceGrid& grid) {
  NodeSurface out{.grid = grid.with_cell(grid.cell / 2),
                  .window = {2 * cells.column, 2 * cells.row, 2 * cells.columns, 2 * cells.rows},
                  .heights = {}};
  out.heights.reserve(static_cast<std::size_t>(out.window.cells()));
  for (std::int64_t r = 0; r < out.window.rows; ++r)
    for (std::int64_t c = 0; c < out.window.columns; ++c) {
      const std::int64_t i = c / 2, j = r / 2, di = c % 2 == 0 ? -1 : 1, dj = r % 2 == 0 ? -1 : 1;
      float sum = 0, weight = 0;
      const auto add = [&](std::int64_t at_c, std::int64_t at_r, float w) {
        if (!heights.contains(at_c, at_r) || std::isnan(heights(at_c, at_r))) return;
        sum += w * heights(at_c, at_r);
        weight += w;
      };
      add(i, j, 9);
      add(i + di, j, 3);
      add(i, j + dj, 3);
      add(i + di, j + dj, 1);
      out.heights.push_back(std::isnan(heights(i, j)) ? heights(i, j) : sum / weight);
    }
  return out;
}

}  // namespace

std::vector<RefinedHeight> refine_heights(const Grid<float>& heights, const Grid<float>& sd,
                                          const SurfaceGrid& grid, const Window& window, std::int64_t block,
                                          const ViewsAt& views, const RefineRules& rules) {
  const Window wide = widened(window, kRefineHalo, heights);
  const NodeSurface surface =
      nodes_of(smooth_by_planes(part_of(heights, wide), part_of(sd, wide), rules.smoothing), wide, grid);
  const double node = surface.grid.cell;
  std::vector<RefinedHeight> out(static_cast<std::size_t>(window.cells()));
  for (std::int64_t r0 = window.row; r0 < window.end_row(); r0 += block)
    for (std::int64_t c0 = window.column; c0 < window.end_column(); c0 += block) {
      const std::int64_t columns = std::min(block, window.end_column() - c0),
                         rows = std::min(block, window.end_row() - r0);
      const ComparedViews used = views(c0, r0);
      const std::vector<PlaneMatch> found =
          match_planes(used, surface, {2 * c0, 2 * r0, 2 * columns, 2 * rows}, rules.planes);
      for (std::int64_t n = 0; n < columns * rows; ++n) {
        const std::int64_t c = c0 + n % columns, r = r0 + n / columns;
        const PlaneMatch& match = found[static_cast<std::size_t>(n)];
        RefinedHeight& to =
            out[static_cast<std::size_t>((r - window.row) * window.columns + c - window.column)];
        to = {heights(c, r), sd(c, r)};
        if (std::isnan(to.height) || std::isnan(match.shift)) continue;
        float base = 0;
        for (int k = 0; k < 4; ++k) base += surface.at(2 * c + k % 2, 2 * r + k / 2) / 4;
        to.height = base + match.shift;
        to.sd = static_cast<float>(std::hypot(rules.match_sd * static_cast<double>(match.sd),
                                              rules.pixel_sd * node / std::tan(used.angle)));
      }
    }
  return out;
}

}  // namespace waymark::pipeline
