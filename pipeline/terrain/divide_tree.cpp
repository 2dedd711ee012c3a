// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/divide_tree.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <unordered_map>

#include "pipeline/terrain/cell_order.hpp"
#include "pipeline/terrain/neighbourhood.hpp"

namespace waymark::pipeline {
namespace {

constexpr std::int32_t kUnlabelled = -1;

// Computation of one tile. Local columns and rows refer to the grown window, so owned cells begin at (1, 1).
class TileSurvey {
 public:
  TileSurvey(const HeightWindow& heights, const Window& owned, const GridGeometry& grid,
             const DivideTreeOptions& options)
      : heights_(heights),
        owned_(owned),
        grid_(grid),
        options_(options),
        labels_(owned.columns, owned.rows, kUnlabelled) {
    for (std::int64_t c = owned.column - 1; c <= owned.end_column(); ++c)
      grid_column_.push_back(grid.wraps ? (c + grid.columns) % grid.columns : c);
    tree_.window = owned;
  }

  DivideTree survey() {
    std::vector<std::uint8_t> masks(static_cast<std::size_t>(owned_.columns));
    for (std::int64_t r = 1; r <= owned_.rows; ++r) {
      higher_neighbours(&heights_(1, r - 1), &heights_(1, r), &heights_(1, r + 1), masks);
      fix_ties_at_wrap(masks, r);
      find_critical_cells(masks, r);
    }
    for (const auto& saddle : saddle_cells_) add_saddle(saddle);
    note_contacts();
    label_border();
    tree_.maxima = std::ranges::count(tree_.nodes, false, &DivideTree::Node::portal);
    tree_.min_prominence = options_.min_prominence;
    std::ranges::sort(tree_.saddles, [](const auto& p, const auto& q) {
      return is_higher(p.height, p.cell, q.height, q.cell);
    });
    return prune(std::move(tree_), options_.min_prominence);
  }

 private:
  std::int64_t cell(std::int64_t c, std::int64_t r) const {
    return grid_.index(grid_column_[static_cast<std::size_t>(c)], owned_.row + r - 1);
  }
  bool is_owned(std::int64_t c, std::int64_t r) const {
    return c >= 1 && c <= owned_.columns && r >= 1 && r <= owned_.rows;
  }

  // Row order and cell order differ between the first and last column of a grid that wraps.
  void fix_ties_at_wrap(std::span<std::uint8_t> masks, std::int64_t r) const {
    if (!grid_.wraps) return;
    constexpr unsigned east = 1u << 2, west = 1u << 6;
    if (owned_.column == 0 && heights_(0, r) == heights_(1, r))
      masks.front() = static_cast<std::uint8_t>(masks.front() & ~west);
    const std::int64_t last = owned_.columns;
    if (owned_.end_column() == grid_.columns && heights_(last + 1, r) == heights_(last, r))
      masks.back() = static_cast<std::uint8_t>(masks.back() | east);
  }

  void find_critical_cells(std::span<const std::uint8_t> masks, std::int64_t r) {
    for (std::int64_t c = 1; c <= owned_.columns; ++c) {
      const std::uint8_t parts = connected_parts(masks[static_cast<std::size_t>(c - 1)]);
      const double height = heights_(c, r);
      if (height == kNoHeight) {
        ++tree_.voids.empty;
        continue;
      }
      count(height);
      if (std::has_single_bit(parts)) continue;  // a slope
      if (parts == 0)
        labels_(c - 1, r - 1) = add_node(c, r, false);
      else
        saddle_cells_.push_back({c, r, parts});
    }
  }

  void count(double height) {
    if (tree_.cells++ == 0) tree_.lowest = tree_.highest = height;
    tree_.lowest = std::min(tree_.lowest, height);
    tree_.highest = std::max(tree_.highest, height);
  }

  std::int32_t add_node(std::int64_t c, std::int64_t r, bool portal) {
    tree_.nodes.push_back({cell(c, r), heights_(c, r), kNoHeight, portal});
    return static_cast<std::int32_t>(tree_.nodes.size() - 1);
  }

  struct SaddleCell {
    std::int64_t column, row;
    std::uint8_t parts;
  };

  void add_saddle(const SaddleCell& at) {
    std::int32_t first = kUnlabelled;
    for (std::size_t i = 0; i < kRing.size(); ++i) {
      if (!(at.parts >> i & 1)) continue;
      const std::int32_t node = summit_above(at.column + kRing[i].column, at.row + kRing[i].row);
      if (first == kUnlabelled)
        first = node;
      else if (node != first)
        tree_.saddles.push_back({cell(at.column, at.row), heights_(at.column, at.row), first, node});
    }
  }

  // Follows steepest ascent to a local maximum or out of the tile, and caches the result for each cell
  // passed.
  std::int32_t summit_above(std::int64_t c, std::int64_t r) {
    path_.clear();
    while (is_owned(c, r) && labels_(c - 1, r - 1) == kUnlabelled) {
      path_.push_back(&labels_(c - 1, r - 1));
      const NeighbourStep up = steepest_step(c, r);
      c += up.column;
      r += up.row;
    }
    const std::int32_t node = is_owned(c, r) ? labels_(c - 1, r - 1) : portal_to(c, r);
    for (std::int32_t* label : path_) *label = node;
    return node;
  }

  NeighbourStep steepest_step(std::int64_t c, std::int64_t r) const {
    NeighbourStep best{0, 0};
    double best_height = heights_(c, r);
    std::int64_t best_cell = cell(c, r);
    for (const NeighbourStep step : kRing) {
      const double height = heights_(c + step.column, r + step.row);
      if (height < best_height) continue;
      const std::int64_t there = cell(c + step.column, r + step.row);
      if (!is_higher(height, there, best_height, best_cell)) continue;
      best = step;
      best_height = height;
      best_cell = there;
    }
    return best;
  }

  std::int32_t portal_to(std::int64_t c, std::int64_t r) {
    const auto [found, is_new] = portals_.try_emplace(cell(c, r), 0);
    if (is_new) found->second = add_node(c, r, true);
    return found->second;
  }

  enum class Unknown { none, beyond_grid, empty };

  // Returns whether the height of a neighbour is unknown, and why.
  Unknown unknown(std::int64_t c, std::int64_t r) const {
    if (heights_(c, r) != kNoHeight) return Unknown::none;
    const std::int64_t row = owned_.row + r - 1;
    if (row < 0) return grid_.north_pole ? Unknown::none : Unknown::beyond_grid;
    if (row >= grid_.rows) return grid_.south_pole ? Unknown::none : Unknown::beyond_grid;
    const std::int64_t column = grid_column_[static_cast<std::size_t>(c)];
    return column < 0 || column >= grid_.columns ? Unknown::beyond_grid : Unknown::empty;
  }

  void note_contacts() {
    std::vector<bool> row_has_void;
    for (std::int64_t r = 0; r <= owned_.rows + 1; ++r)
      row_has_void.push_back(std::ranges::find(heights_.row(r), kNoHeight) != heights_.row(r).end());
    for (std::int64_t r = 1; r <= owned_.rows; ++r) {
      const auto at = static_cast<std::size_t>(r);
      if (!row_has_void[at - 1] && !row_has_void[at] && !row_has_void[at + 1]) continue;
      for (std::int64_t c = 1; c <= owned_.columns; ++c)
        if (heights_(c, r) != kNoHeight && touches_hidden_terrain(c, r)) {
          DivideTree::Node& node = tree_.nodes[static_cast<std::size_t>(summit_above(c, r))];
          node.contact = std::max(node.contact, heights_(c, r));
        }
    }
  }

  bool touches_hidden_terrain(std::int64_t c, std::int64_t r) {
    bool beyond_grid = false, empty = false;
    for (const NeighbourStep s : kRing) {
      const Unknown why = unknown(c + s.column, r + s.row);
      beyond_grid |= why == Unknown::beyond_grid;
      empty |= why == Unknown::empty;
    }
    const bool gap = empty && heights_(c, r) > options_.hidden_above;
    tree_.voids.rim += gap ? 1 : 0;
    return beyond_grid || gap;
  }

  void label_border() {
    const bool west = grid_.wraps || owned_.column > 0;
    const bool east = grid_.wraps || owned_.end_column() < grid_.columns;
    const bool north = owned_.row > 0, south = owned_.end_row() < grid_.rows;
    for (std::int64_t r = 1; r <= owned_.rows; ++r) {
      const bool whole_row = (north && r == 1) || (south && r == owned_.rows);
      for (std::int64_t c = 1; c <= owned_.columns;) {
        const bool beside = whole_row || (west && c == 1) || (east && c == owned_.columns);
        if (beside && heights_(c, r) != kNoHeight)
          tree_.border.push_back({cell(c, r), heights_(c, r), summit_above(c, r)});
        c = whole_row || c == owned_.columns ? c + 1 : owned_.columns;
      }
    }
    std::ranges::sort(tree_.border, {}, &DivideTree::Border::cell);
  }

  const HeightWindow& heights_;
  const Window owned_;
  const GridGeometry& grid_;
  const DivideTreeOptions options_;
  std::vector<std::int64_t> grid_column_;  // of each local column
  Grid<std::int32_t> labels_;
  std::vector<SaddleCell> saddle_cells_;
  std::unordered_map<std::int64_t, std::int32_t> portals_;
  std::vector<std::int32_t*> path_;
  DivideTree tree_;
};

}  // namespace

DivideTree::Voids& DivideTree::Voids::operator+=(const Voids& other) {
  empty += other.empty;
  rim += other.rim;
  faults.filled += other.faults.filled;
  if (faults.implausible == 0) {
    faults.height = other.faults.height;
    faults.column = other.faults.column;
    faults.row = other.faults.row;
  }
  faults.implausible += other.faults.implausible;
  return *this;
}

DivideTree build_divide_tree(const HeightWindow& heights, const Window& owned, const GridGeometry& grid,
                             const DivideTreeOptions& options) {
  assert(heights.columns() == owned.columns + 2 && heights.rows() == owned.rows + 2);
  return TileSurvey(heights, owned, grid, options).survey();
}

}  // namespace waymark::pipeline
