// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/survey_outline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/forest/crowns.hpp"

namespace waymark::pipeline {
namespace {

constexpr std::int64_t kBlocks = 256;  // along the longer side
constexpr double kMinKnown = 0.995;    // fraction of samples of a full rectangle
constexpr int kMinHole = 16;           // blocks

using Mask = Grid<std::uint8_t>;

/// Blocks of the common grid, and which of them have data.
struct SurveyBlocks {
  std::int64_t side = 1;  ///< cells
  Mask known;
  double fraction = 0;  ///< of the samples of all blocks that have data
};

/// Counts, block by block, the cells with data in the middle row of each row of blocks.
SurveyBlocks surveyed_blocks(const Canopies& canopies, const GridGeometry& common) {
  SurveyBlocks blocks;
  blocks.side = std::max<std::int64_t>(1, (std::max(common.columns, common.rows) + kBlocks - 1) / kBlocks);
  const auto count = [&](std::int64_t cells) { return (cells + blocks.side - 1) / blocks.side; };
  Grid<double> max_known(count(common.columns), count(common.rows), 0);  // known fraction by any canopy
  for (const auto& canopy : canopies) {
    const GridGeometry& grid = canopy->geometry();
    for (std::int64_t j = 0; j < max_known.rows(); ++j) {
      const auto middle = static_cast<double>(std::min(j * blocks.side + blocks.side / 2, common.rows - 1));
      const std::int64_t row = std::llround((common.where.y(middle) - grid.where.y0) / grid.where.dy);
      if (row < 0 || row >= grid.rows) continue;
      const Grid<float> heights = canopy->read({0, row, grid.columns, 1});
      for (std::int64_t i = 0; i < max_known.columns(); ++i) {
        const std::int64_t end = std::min((i + 1) * blocks.side, common.columns);
        std::int64_t known = 0;
        for (std::int64_t c = i * blocks.side; c < end; ++c) {
          const double x = common.where.x(static_cast<double>(c));
          const std::int64_t column = std::llround((x - grid.where.x0) / grid.where.dx);
          known += heights.contains(column, 0) && heights(column, 0) > kNoCanopy;
        }
        max_known(i, j) = std::max(max_known(i, j),
                                   static_cast<double>(known) / static_cast<double>(end - i * blocks.side));
      }
    }
  }
  blocks.known = Mask(max_known.columns(), max_known.rows());
  for (std::size_t i = 0; i < max_known.cells().size(); ++i) {
    blocks.known.cells()[i] = max_known.cells()[i] >= 0.5;
    blocks.fraction += max_known.cells()[i] / static_cast<double>(max_known.cells().size());
  }
  return blocks;
}

/// Removes the cells that are connected to a cell by edges from `mask` and returns them as a mask.
Mask take_component(Mask& mask, CanopyCell start) {
  Mask component(mask.columns(), mask.rows());
  std::vector<CanopyCell> open{start};
  mask(start.column, start.row) = 0;
  while (!open.empty()) {
    const CanopyCell at = open.back();
    open.pop_back();
    component(at.column, at.row) = 1;
    for (const auto& [dc, dr] : {std::pair(-1, 0), {1, 0}, {0, -1}, {0, 1}}) {
      const CanopyCell next{at.column + dc, at.row + dr};
      if (!mask.contains(next.column, next.row) || !mask(next.column, next.row)) continue;
      mask(next.column, next.row) = 0;
      open.push_back(next);
    }
  }
  return component;
}

std::vector<Mask> components(Mask mask) {
  std::vector<Mask> found;
  for (std::int64_t r = 0; r < mask.rows(); ++r)
    for (std::int64_t c = 0; c < mask.columns(); ++c)
      if (mask(c, r)) found.push_back(take_component(mask, {c, r}));
  return found;
}

/// Returns the cells without data that the cells of a component enclose.
Mask gaps_of(const Mask& component) {
  Mask outside(component.columns() + 2, component.rows() + 2, 1);
  for (std::int64_t r = 0; r < component.rows(); ++r)
    for (std::int64_t c = 0; c < component.columns(); ++c) outside(c + 1, r + 1) = !component(c, r);
  take_component(outside, {0, 0});
  Mask gaps(component.columns(), component.rows());
  for (std::int64_t r = 0; r < gaps.rows(); ++r)
    for (std::int64_t c = 0; c < gaps.columns(); ++c) gaps(c, r) = outside(c + 1, r + 1);
  return gaps;
}

std::vector<Eigen::Vector2d> in_map(const std::vector<CanopyCell>& ring, const GridGeometry& common,
                                    std::int64_t side) {
  std::vector<Eigen::Vector2d> corners;
  for (const CanopyCell& corner : ring)
    corners.emplace_back(
        common.where.x(static_cast<double>(std::min(corner.column * side, common.columns)) - 0.5),
        common.where.y(static_cast<double>(std::min(corner.row * side, common.rows)) - 0.5));
  return corners;
}

}  // namespace

std::vector<SurveyedPart> survey_outline(const Canopies& canopies) {
  const GridGeometry common = common_grid(canopies);
  SurveyBlocks blocks = surveyed_blocks(canopies, common);
  if (blocks.fraction >= kMinKnown) std::ranges::fill(blocks.known.cells(), std::uint8_t{1});
  std::vector<SurveyedPart> parts;
  for (const Mask& component : components(std::move(blocks.known))) {
    SurveyedPart part{.outer = in_map(outline_of(component, 0, 0).ring, common, blocks.side), .holes = {}};
    for (const Mask& gap : components(gaps_of(component)))
      if (std::ranges::count(gap.cells(), 1) >= kMinHole)
        part.holes.push_back(in_map(outline_of(gap, 0, 0).ring, common, blocks.side));
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace waymark::pipeline
