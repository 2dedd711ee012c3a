// SPDX-License-Identifier: Apache-2.0
#include "exporters/view/view_frame.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::exporters {
namespace {

constexpr int kCrsNodes = 33;  // per side

std::size_t crs_node(int column, int row) {
  return static_cast<std::size_t>(row * kCrsNodes + column);
}

}  // namespace

Eigen::Vector3d ViewFrame::from_crs(const Point<MapCrs>& point) const {
  return frame_.map_frame_from_crs(point).xyz - middle_;
}

Eigen::Vector3d ViewFrame::to_crs(const Eigen::Vector3d& at) const {
  Eigen::Vector3d xyz = frame_.crs_from_map_frame({at + middle_}).xyz;
  if (crs_.kind() == CrsKind::geographic) {
    const double near_x = frame_.crs_from_map_frame({middle_}).xyz.x();
    xyz.x() -= 360 * std::round((xyz.x() - near_x) / 360);
  }
  return xyz;
}

Eigen::Matrix3d ViewFrame::rotation_from_grid(const Point<MapCrs>& at) const {
  if (crs_.kind() == CrsKind::local) return Eigen::Matrix3d::Identity();
  const double step = crs_.kind() == CrsKind::geographic ? 1e-4 : 10;
  const auto moved = [&](double dx, double dy, double dz) {
    return from_crs({at.xyz + Eigen::Vector3d(dx, dy, dz)});
  };
  // Columns by central differences, then made orthogonal: the map's scale is not part of a rotation.
  Eigen::Matrix3d r;
  r.col(1) = (moved(0, step, 0) - moved(0, -step, 0)).normalized();
  r.col(2) = (moved(0, 0, 10) - moved(0, 0, -10)).normalized();
  r.col(0) = r.col(1).cross(r.col(2)).normalized();
  r.col(1) = r.col(2).cross(r.col(0));
  return r;
}

CrsGrid::CrsGrid(const ViewFrame& frame, const Eigen::AlignedBox2d& area) : area_(area) {
  nodes_.reserve(kCrsNodes * kCrsNodes);
  for (int row = 0; row < kCrsNodes; ++row)
    for (int column = 0; column < kCrsNodes; ++column) {
      const Eigen::Vector2d at =
          area.min() + (Eigen::Array2d(column, row) / (kCrsNodes - 1) * area.sizes().array()).matrix();
      nodes_.push_back(frame.to_crs({at.x(), at.y(), 0}));
    }
}

Eigen::Vector3d CrsGrid::at(const Eigen::Vector2d& position) const {
  const Eigen::Array2d g =
      ((position - area_.min()).array() / area_.sizes().array() * (kCrsNodes - 1)).eval();
  const int column = std::clamp(static_cast<int>(std::floor(g.x())), 0, kCrsNodes - 2);
  const int row = std::clamp(static_cast<int>(std::floor(g.y())), 0, kCrsNodes - 2);
  const double u = g.x() - column, v = g.y() - row;
  return (1 - v) * ((1 - u) * nodes_[crs_node(column, row)] + u * nodes_[crs_node(column + 1, row)]) +
         v * ((1 - u) * nodes_[crs_node(column, row + 1)] + u * nodes_[crs_node(column + 1, row + 1)]);
}

Extent CrsGrid::extent() const {
  Extent all{nodes_[0].x(), nodes_[0].y(), nodes_[0].x(), nodes_[0].y()};
  for (const Eigen::Vector3d& node : nodes_)
    if (node.allFinite()) all = all.united({node.x(), node.y(), node.x(), node.y()});
  return all;
}

}  // namespace waymark::exporters
