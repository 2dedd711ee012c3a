// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/cell_tree.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::pipeline {
namespace {

constexpr double kSlack = 1 + 1e-9;  // distances to a box and to a point in it are rounded differently

}  // namespace

CellTree::CellTree(std::vector<Eigen::Vector3d> points, std::size_t max_in_leaf) {
  std::erase_if(points, [](const Eigen::Vector3d& p) { return !p.allFinite(); });
  root_ = build(points.begin(), points.end(), std::max<std::size_t>(max_in_leaf, 1));
}

std::uint32_t CellTree::build(std::vector<Eigen::Vector3d>::iterator begin,
                              std::vector<Eigen::Vector3d>::iterator end, std::size_t max_in_leaf) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Eigen::Index axis = 0;
  double split = std::nan("");
  if (static_cast<std::size_t>(end - begin) > max_in_leaf) {
    Eigen::Vector3d low = *begin, high = *begin;
    for (auto p = begin; p != end; ++p) low = low.cwiseMin(*p), high = high.cwiseMax(*p);
    if ((high - low).maxCoeff(&axis) > 0) {
      const auto middle = begin + (end - begin) / 2;
      std::nth_element(begin, middle, end, [&](const auto& a, const auto& b) { return a[axis] < b[axis]; });
      // Equal points go to one side: the split is above the lowest value.
      split = (*middle)[axis] > low[axis] ? (*middle)[axis] : high[axis];
    }
  }
  if (std::isnan(split)) {
    nodes_[number].below = count_++;
    return number;
  }
  const auto above = std::partition(begin, end, [&](const Eigen::Vector3d& p) { return p[axis] < split; });
  const std::uint32_t low_node = build(begin, above, max_in_leaf);
  const std::uint32_t high_node = build(above, end, max_in_leaf);
  nodes_[number] = {static_cast<int>(axis), split, low_node, high_node, 0};
  return number;
}

std::uint32_t CellTree::find(const Eigen::Vector3d& point) const {
  std::uint32_t node = root_;
  while (nodes_[node].axis >= 0)
    node = point[nodes_[node].axis] < nodes_[node].split ? nodes_[node].below : nodes_[node].above;
  return nodes_[node].below;
}

void CellTree::set_reach(const std::vector<double>& of_cell) {
  collect_reach(root_, of_cell);
}

double CellTree::collect_reach(std::uint32_t node, const std::vector<double>& of_cell) {
  Node& own = nodes_[node];
  own.reach = own.axis < 0 ? of_cell.at(own.below)
                           : std::max(collect_reach(own.below, of_cell), collect_reach(own.above, of_cell));
  return own.reach;
}

void CellTree::visit_near(const Eigen::Vector3d& point, double reach,
                          const std::function<void(std::uint32_t)>& take) const {
  visit_near(root_, point, reach, Eigen::Vector3d::Zero(), take);
}

// `apart`: distance of the point from the node's box, by axis.
void CellTree::visit_near(std::uint32_t node, const Eigen::Vector3d& point, double reach,
                          Eigen::Vector3d apart, const std::function<void(std::uint32_t)>& take) const {
  const Node& own = nodes_[node];
  if (apart.norm() > (reach + own.reach) * kSlack) return;
  if (own.axis < 0) return take(own.below);
  const bool is_below = point[own.axis] < own.split;
  visit_near(is_below ? own.below : own.above, point, reach, apart, take);
  apart[own.axis] = std::abs(point[own.axis] - own.split);
  visit_near(is_below ? own.above : own.below, point, reach, apart, take);
}

}  // namespace waymark::pipeline
