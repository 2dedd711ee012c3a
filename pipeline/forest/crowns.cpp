// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/crowns.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "pipeline/forest/local_maxima.hpp"

namespace waymark::pipeline {
namespace {

using Index = std::int32_t;
constexpr Index kNoTree = -1;

class Watershed {
 public:
  Watershed(const CanopyWindow& smooth, const std::vector<Treetop>& tops, const CrownRules& rules)
      : smooth_(smooth),
        heights_(smooth.heights),
        rules_(rules),
        tops_(tops),
        columns_(static_cast<Index>(heights_.columns())),
        rows_(static_cast<Index>(heights_.rows())),
        longest_(2 * crown_radius_cells()) {
    follow_ascent();
    label_tops();
    merge_minor_maxima();
  }

  Crown crown_of(Index top) {
    const Treetop& tree = tops_[static_cast<std::size_t>(top)];
    const Index c0 = column_of(tree), r0 = row_of(tree);
    const auto floor = static_cast<float>(std::max(rules_.floor, rules_.min_height_fraction * tree.height));
    const double radius = rules_.radius(tree.height);
    crown_.assign(1, {c0, r0});
    taken_[cell(c0, r0)] = 1;
    Index left = c0, right = c0, upper = r0, lower = r0;
    for (std::size_t i = 0; i < crown_.size(); ++i) {
      constexpr CellStep kEdges[] = {{0, -1}, {-1, 0}, {1, 0}, {0, 1}};
      for (const auto& [dc, dr] : kEdges) {
        const Index c = crown_[i].column + dc, r = crown_[i].row + dr;
        if (c < 0 || r < 0 || c >= columns_ || r >= rows_ || taken_[cell(c, r)]) continue;
        const Index peak = peak_[cell(c, r)];
        if (peak == kNoTree || label_[static_cast<std::size_t>(peak)] != top) continue;
        if (!(heights_(c, r) >= floor) || !(metres(c - c0, r - r0) <= radius)) continue;
        taken_[cell(c, r)] = 1;
        crown_.push_back({c, r});
        left = std::min(left, c), right = std::max(right, c);
        upper = std::min(upper, r), lower = std::max(lower, r);
      }
    }
    Grid<std::uint8_t> inside(right - left + 1, lower - upper + 1, 0);
    for (const Spot& s : crown_) inside(s.column - left, s.row - upper) = 1;
    Outline outline = outline_of(inside, left + smooth_.cells.column, upper + smooth_.cells.row);
    return {tree, outline.cells, std::move(outline.ring)};
  }

 private:
  struct Spot {
    Index column, row;
  };

  Index crown_radius_cells() const {
    return static_cast<Index>(crown_reach(rules_, std::min(smooth_.cell_width, smooth_.cell_height)));
  }
  std::size_t cell(Index c, Index r) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c);
  }
  Index column_of(const Treetop& t) const { return static_cast<Index>(t.cell.column - smooth_.cells.column); }
  Index row_of(const Treetop& t) const { return static_cast<Index>(t.cell.row - smooth_.cells.row); }
  double metres(Index columns, Index rows) const {
    return std::hypot(columns * smooth_.cell_width, rows * smooth_.cell_height);
  }
  // cell_order.hpp for two cells of the window.
  bool is_above(std::size_t a, std::size_t b) const {
    const float ha = heights_.cells()[a], hb = heights_.cells()[b];
    return ha != hb ? ha > hb : a < b;
  }

  // The highest neighbour above each cell; the cell itself at a maximum.
  std::vector<Index> steepest() const {
    std::vector<Index> up(heights_.cells().size(), kNoTree);
    for (Index r = 0; r < rows_; ++r)
      for (Index c = 0; c < columns_; ++c) {
        const std::size_t here = cell(c, r);
        if (!(heights_.cells()[here] >= rules_.floor)) continue;
        std::size_t best = here;
        for (const auto& [dc, dr] : kNeighbours) {
          if (c + dc < 0 || r + dr < 0 || c + dc >= columns_ || r + dr >= rows_) continue;
          const std::size_t other = cell(c + dc, r + dr);
          if (is_above(other, best)) best = other;
        }
        up[here] = static_cast<Index>(best);
      }
    return up;
  }

  // Follows the steepest ascent from every cell; cells whose path is longer than `longest_` get no maximum.
  void follow_ascent() {
    const std::vector<Index> up = steepest();
    peak_.assign(up.size(), kNoTree);
    std::vector<Index> length(up.size(), 0), way;
    for (std::size_t i = 0; i < up.size(); ++i) {
      if (up[i] == kNoTree) continue;
      std::size_t at = i;
      way.clear();
      while (length[at] == 0 && static_cast<std::size_t>(up[at]) != at) {
        way.push_back(static_cast<Index>(at));
        at = static_cast<std::size_t>(up[at]);
      }
      if (static_cast<std::size_t>(up[at]) == at && length[at] == 0) {
        length[at] = 1;
        peak_[at] = static_cast<Index>(maxima_.size());
        maxima_.push_back(static_cast<Index>(at));
      }
      const Index end = summit_of(at, up);
      for (auto back = way.rbegin(); back != way.rend(); ++back) {
        const auto here = static_cast<std::size_t>(*back);
        length[here] = length[static_cast<std::size_t>(up[here])] + 1;
        peak_[here] = length[here] <= longest_ ? end : kNoTree;
      }
    }
    taken_.assign(up.size(), 0);
  }

  // The maximum at the end of the steepest ascent from a cell.
  Index summit_of(std::size_t at, const std::vector<Index>& up) const {
    while (peak_[at] == kNoTree) at = static_cast<std::size_t>(up[at]);
    return peak_[at];
  }

  void label_tops() {
    label_.assign(maxima_.size(), kNoTree);
    for (std::size_t t = 0; t < tops_.size(); ++t) {
      const Index peak = peak_[cell(column_of(tops_[t]), row_of(tops_[t]))];
      if (peak != kNoTree) label_[static_cast<std::size_t>(peak)] = static_cast<Index>(t);
    }
  }

  // Merges maxima that are no tops, highest first, into the tree they lead to.
  void merge_minor_maxima() {
    std::vector<Index> order;
    for (std::size_t m = 0; m < maxima_.size(); ++m)
      if (label_[m] == kNoTree) order.push_back(static_cast<Index>(m));
    const auto place = [&](Index m) {
      return static_cast<std::size_t>(maxima_[static_cast<std::size_t>(m)]);
    };
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return is_above(place(a), place(b)); });
    seen_.assign(heights_.cells().size(), 0);
    for (const Index m : order) {
      const Index beyond = higher_cell(place(m));
      if (beyond == kNoTree) continue;
      const Index peak = peak_[static_cast<std::size_t>(beyond)];
      const Index top = peak == kNoTree ? kNoTree : label_[static_cast<std::size_t>(peak)];
      if (top == kNoTree) continue;
      const Treetop& tree = tops_[static_cast<std::size_t>(top)];
      const auto at = static_cast<Index>(place(m));
      if (metres(at % columns_ - column_of(tree), at / columns_ - row_of(tree)) <= rules_.max_radius)
        label_[static_cast<std::size_t>(m)] = top;
    }
  }

  // The first cell above `from` across the highest saddle, within the maximum radius.
  Index higher_cell(std::size_t from) {
    const auto lower = [this](Index a, Index b) {
      return is_above(static_cast<std::size_t>(b), static_cast<std::size_t>(a));
    };
    ++stamp_;
    seen_[from] = stamp_;
    open_.assign(1, static_cast<Index>(from));
    const auto c0 = static_cast<Index>(from % static_cast<std::size_t>(columns_));
    const auto r0 = static_cast<Index>(from / static_cast<std::size_t>(columns_));
    while (!open_.empty()) {
      std::pop_heap(open_.begin(), open_.end(), lower);
      const Index at = open_.back();
      open_.pop_back();
      if (is_above(static_cast<std::size_t>(at), from)) return at;
      const Index c = at % columns_, r = at / columns_;
      for (const auto& [dc, dr] : kNeighbours) {
        if (c + dc < 0 || r + dr < 0 || c + dc >= columns_ || r + dr >= rows_) continue;
        const std::size_t next = cell(c + dc, r + dr);
        if (seen_[next] == stamp_ || !(heights_.cells()[next] >= rules_.floor)) continue;
        if (metres(c + dc - c0, r + dr - r0) > rules_.max_radius) continue;
        seen_[next] = stamp_;
        open_.push_back(static_cast<Index>(next));
        std::push_heap(open_.begin(), open_.end(), lower);
      }
    }
    return kNoTree;
  }

  const CanopyWindow& smooth_;
  const Grid<float>& heights_;
  const CrownRules& rules_;
  const std::vector<Treetop>& tops_;
  Index columns_, rows_, longest_;
  std::vector<Index> peak_;    // per cell: index of the maximum that it ascends to
  std::vector<Index> maxima_;  // cells
  std::vector<Index> label_;   // per maximum: index of its tree
  std::vector<std::uint8_t> taken_;
  std::vector<std::uint32_t> seen_;
  std::uint32_t stamp_ = 0;
  std::vector<Index> open_;
  std::vector<Spot> crown_;
};

}  // namespace

std::int64_t crown_reach(const CrownRules& rules, double cell) {
  return static_cast<std::int64_t>(std::ceil(rules.max_radius / cell)) + 1;
}

std::vector<Crown> find_crowns(const CanopyWindow& smooth, const Window& owned,
                               const std::vector<Treetop>& tops, const CrownRules& rules) {
  Watershed watershed(smooth, tops, rules);
  std::vector<Crown> crowns;
  for (std::size_t t = 0; t < tops.size(); ++t)
    if (owned.contains(tops[t].cell.column, tops[t].cell.row))
      crowns.push_back(watershed.crown_of(static_cast<std::int32_t>(t)));
  return crowns;
}

}  // namespace waymark::pipeline
