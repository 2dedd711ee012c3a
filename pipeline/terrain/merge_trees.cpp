// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/merge_trees.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <unordered_map>

#include "pipeline/terrain/cell_order.hpp"

namespace waymark::pipeline {
namespace {

using TreeParts = std::span<const std::shared_ptr<const DivideTree>>;

constexpr std::int32_t kUnresolved = -1;

// A node of a part.
struct PartNode {
  std::size_t part = 0;
  std::int32_t node = 0;
};

class TreeMerger {
 public:
  TreeMerger(TreeParts parts, const Window& united, const GridGeometry& grid)
      : parts_(parts), united_(united), grid_(grid) {
    std::size_t count = 0;
    for (const auto& part : parts) count += part->nodes.size();
    if (count > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
      throw std::length_error("a merged divide tree has more than 2^31 nodes");
    for (const auto& part : parts) number_.emplace_back(part->nodes.size(), kUnresolved);
  }

  DivideTree merge() {
    add_totals();
    for (std::size_t p = 0; p < parts_.size(); ++p)
      for (std::size_t n = 0; n < parts_[p]->nodes.size(); ++n) {
        const auto& node = parts_[p]->nodes[n];
        auto& kept = merged_.nodes[static_cast<std::size_t>(number_of({p, static_cast<std::int32_t>(n)}))];
        kept.contact = std::max(kept.contact, node.contact);
      }
    add_saddles();
    add_border();
    const double min_prominence = merged_.min_prominence;
    return prune(std::move(merged_), min_prominence);
  }

 private:
  void add_totals() {
    merged_.window = united_;
    for (const auto& part : parts_) {
      if (part->cells > 0) {
        merged_.lowest = merged_.cells > 0 ? std::min(merged_.lowest, part->lowest) : part->lowest;
        merged_.highest = merged_.cells > 0 ? std::max(merged_.highest, part->highest) : part->highest;
      }
      merged_.cells += part->cells;
      merged_.maxima += part->maxima;
      merged_.min_prominence = part->min_prominence;
      merged_.voids += part->voids;
    }
  }

  // Returns the node of the merged tree that stands for a node of a part: its own, or that of the summit
  // behind a portal. Portals to the same cell outside are one node.
  std::int32_t number_of(PartNode at) {
    path_.clear();
    while (number_[at.part][static_cast<std::size_t>(at.node)] == kUnresolved) {
      path_.push_back(at);
      const auto& node = parts_[at.part]->nodes[static_cast<std::size_t>(at.node)];
      const std::size_t owner = node.portal ? part_of(node.cell) : parts_.size();
      if (owner < parts_.size()) {
        at = {owner, border_node(owner, node.cell)};
        continue;
      }
      number_[at.part][static_cast<std::size_t>(at.node)] = add_node(node);
    }
    const std::int32_t number = number_[at.part][static_cast<std::size_t>(at.node)];
    for (const PartNode& passed : path_) number_[passed.part][static_cast<std::size_t>(passed.node)] = number;
    return number;
  }

  std::int32_t add_node(const DivideTree::Node& node) {
    const auto next = static_cast<std::int32_t>(merged_.nodes.size());
    if (node.portal) {
      const auto [found, is_new] = portals_.try_emplace(node.cell, next);
      if (!is_new) return found->second;
    }
    merged_.nodes.push_back(node);
    return next;
  }

  // Returns the part whose window contains a cell; the number of parts if none does.
  std::size_t part_of(std::int64_t cell) const {
    const std::int64_t column = cell % grid_.columns, row = cell / grid_.columns;
    const auto found =
        std::ranges::find_if(parts_, [&](const auto& part) { return part->window.contains(column, row); });
    return static_cast<std::size_t>(found - parts_.begin());
  }

  std::int32_t border_node(std::size_t part, std::int64_t cell) const {
    const auto& border = parts_[part]->border;
    const auto found = std::ranges::lower_bound(border, cell, {}, &DivideTree::Border::cell);
    if (found == border.end() || found->cell != cell)
      throw std::logic_error("a border cell of the divide tree is missing");
    return found->node;
  }

  // The saddles of each part are in order already.
  void add_saddles() {
    const auto before = [](const DivideTree::Saddle& p, const DivideTree::Saddle& q) {
      return is_higher(p.height, p.cell, q.height, q.cell);
    };
    auto& all = merged_.saddles;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      const auto middle = static_cast<std::ptrdiff_t>(all.size());
      for (const auto& saddle : parts_[p]->saddles) {
        const std::int32_t a = number_of({p, saddle.a}), b = number_of({p, saddle.b});
        if (a != b) all.push_back({saddle.cell, saddle.height, a, b});
      }
      std::inplace_merge(all.begin(), all.begin() + middle, all.end(), before);
    }
  }

  void add_border() {
    for (std::size_t p = 0; p < parts_.size(); ++p)
      for (const auto& border : parts_[p]->border)
        if (is_beside_others(border.cell))
          merged_.border.push_back({border.cell, border.height, number_of({p, border.node})});
    std::ranges::sort(merged_.border, {}, &DivideTree::Border::cell);
  }

  bool is_beside_others(std::int64_t cell) const {
    const std::int64_t column = cell % grid_.columns, row = cell / grid_.columns;
    const bool round = united_.columns == grid_.columns;
    const bool west = column == united_.column && !round && (grid_.wraps || column > 0);
    const bool east =
        column == united_.end_column() - 1 && !round && (grid_.wraps || united_.end_column() < grid_.columns);
    return west || east || (row == united_.row && row > 0) ||
           (row == united_.end_row() - 1 && united_.end_row() < grid_.rows);
  }

  TreeParts parts_;
  const Window united_;
  const GridGeometry& grid_;
  std::vector<std::vector<std::int32_t>> number_;  // by part and node
  std::unordered_map<std::int64_t, std::int32_t> portals_;
  std::vector<PartNode> path_;
  DivideTree merged_;
};

}  // namespace

DivideTree merge_divide_trees(TreeParts parts, const Window& united, const GridGeometry& grid) {
  return TreeMerger(parts, united, grid).merge();
}

void TreePyramid::add(std::shared_ptr<const DivideTree> tile) {
  if (side_ == 0) side_ = std::max(tile->window.columns, tile->window.rows);
  add(0, std::move(tile));
}

void TreePyramid::add(int level, std::shared_ptr<const DivideTree> tree) {
  const Window whole{0, 0, grid_.columns, grid_.rows};
  if (tree->window == whole) {
    whole_ = std::move(tree);
    return;
  }
  const int above = level + 1;
  if (levels_.size() < static_cast<std::size_t>(above)) levels_.resize(static_cast<std::size_t>(above));
  auto& groups = levels_[static_cast<std::size_t>(level)];
  const Key key{tree->window.row / side(above), tree->window.column / side(above)};
  const Window united{key.second * side(above), key.first * side(above),
                      std::min(side(above), grid_.columns - key.second * side(above)),
                      std::min(side(above), grid_.rows - key.first * side(above))};
  Group& group = groups[key];
  group.parts.push_back(std::move(tree));
  std::int64_t cells = 0;
  for (const auto& part : group.parts) cells += part->window.cells();
  if (cells < united.cells()) return;
  auto merged = std::make_shared<const DivideTree>(merge_divide_trees(group.parts, united, grid_));
  groups.erase(key);
  add(above, std::move(merged));
}

}  // namespace waymark::pipeline
