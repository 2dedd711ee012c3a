// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>
namespace waymark::pipeline {

/// Division of space into cells with about equally many points: boxes of a kd-tree, numbered so that
/// neighbours mostly have near numbers. Coordinates are those of MapPlane::to_cartesian, so that neither the
/// antimeridian nor the poles need care.
class CellTree {
 public:
  /// A leaf has at most `max_in_leaf` of the points, unless more of them are equal.
  CellTree(std::vector<Eigen::Vector3d> points, std::size_t max_in_leaf);

  std::uint32_t count() const { return count_; }
  /// Returns the cell of a point; points with NaN have one, too.
  std::uint32_t find(const Eigen::Vector3d& point) const;

  /// Calls take(cell) for the cells whose distance from a point is at most `reach` + the cell's own reach.
  void visit_near(const Eigen::Vector3d& point, double reach,
                  const std::function<void(std::uint32_t)>& take) const;
  /// Sets the reach of each cell, the largest of its objects.
  void set_reach(const std::vector<double>& of_cell);

 private:
  struct Node {
    int axis = -1;  ///< -1: a cell
    double split = 0;
    std::uint32_t below = 0, above = 0;  ///< nodes; of a cell: `below` is its number
    double reach = 0;                    ///< largest of its cells
  };
  std::uint32_t build(std::vector<Eigen::Vector3d>::iterator begin,
                      std::vector<Eigen::Vector3d>::iterator end, std::size_t max_in_leaf);
  double collect_reach(std::uint32_t node, const std::vector<double>& of_cell);
  void visit_near(std::uint32_t node, const Eigen::Vector3d& point, double reach, Eigen::Vector3d apart,
                  const std::function<void(std::uint32_t)>& take) const;

  std::vector<Node> nodes_;
  std::uint32_t root_ = 0, count_ = 0;
};

}  // namespace waymark::pipeline
