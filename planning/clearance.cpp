// SPDX-License-Identifier: Apache-2.0
#include "planning/clearance.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace waymark::planning {
namespace {

constexpr double kBellyCell = 0.1;  // metres, of the squares into which the belly is divided, at least

/// Linear map from the heights of the supports to a plane z = a + b x + c y in the vehicle's axes.
struct PlaneOfSupports {
  std::vector<std::size_t> supports;
  Eigen::MatrixXd from_heights;  // 3 x supports
};

Eigen::MatrixXd design(const Vehicle& vehicle, const std::vector<std::size_t>& supports) {
  Eigen::MatrixXd a(static_cast<Eigen::Index>(supports.size()), 3);
  for (std::size_t i = 0; i < supports.size(); ++i)
    a.row(static_cast<Eigen::Index>(i)) << 1, vehicle.supports[supports[i]].x.value,
        vehicle.supports[supports[i]].y.value;
  return a;
}

/// Whether the middle of the vehicle lies within the triangle of three supports, where it can stand on them.
bool holds_middle(const Eigen::MatrixXd& from_heights) {
  return (from_heights.row(0).array() >= -1e-9).all();  // weights of the supports in the height of the middle
}

std::vector<PlaneOfSupports> planes_of(const Vehicle& vehicle) {
  const std::size_t n = vehicle.supports.size();
  std::vector<PlaneOfSupports> planes;
  if (vehicle.suspension != "rigid") {
    std::vector<std::size_t> all(n);
    for (std::size_t i = 0; i < n; ++i) all[i] = i;
    const Eigen::MatrixXd a = design(vehicle, all);
    planes.push_back({all, (a.transpose() * a).inverse() * a.transpose()});
    return planes;
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t k = j + 1; k < n; ++k) {
        const Eigen::Matrix3d a = design(vehicle, {i, j, k});
        if (std::abs(a.determinant()) < 1e-9) continue;
        const Eigen::Matrix3d inverse = a.inverse();
        if (holds_middle(inverse)) planes.push_back({{i, j, k}, inverse});
      }
  return planes;
}

/// Bounds of sum weights x heights.
HeightRange weighted(const Eigen::RowVectorXd& weights, const PlaneOfSupports& plane,
                     const std::vector<HeightRange>& wheels) {
  HeightRange sum;
  for (std::size_t i = 0; i < plane.supports.size(); ++i) {
    const double w = weights(static_cast<Eigen::Index>(i));
    const HeightRange& h = wheels[plane.supports[i]];
    sum.low += w * (w >= 0 ? h.low : h.high), sum.high += w * (w >= 0 ? h.high : h.low);
  }
  return sum;
}

}  // namespace

std::optional<ClearanceBounds> clearance_bounds(const localization::Pose2& pose, const Vehicle& vehicle,
                                                const TerrainRange& terrain, double position_error,
                                                double height_error) {
  double front = 0, side = 0;
  std::vector<HeightRange> wheels;
  for (const Support& s : vehicle.supports) {
    front = std::max(front, std::abs(s.x.value)), side = std::max(side, std::abs(s.y.value));
    // A wheel touches the terrain within its radius ahead and behind, and its width.
    const double half = std::hypot(s.diameter.value, s.width.value) / 2 + position_error;
    const auto range = terrain((pose * localization::Pose2{s.x.value, s.y.value, 0}).at(), half);
    if (!range) return {};
    wheels.push_back({range->low - height_error, range->high + height_error});
  }
  ClearanceBounds bounds{std::numeric_limits<double>::infinity(), 0};
  const std::vector<PlaneOfSupports> planes = planes_of(vehicle);
  for (const PlaneOfSupports& plane : planes) {
    const auto steepest = [&](Eigen::Index row) {
      const HeightRange g = weighted(plane.from_heights.row(row), plane, wheels);
      return std::max(std::abs(g.low), std::abs(g.high));
    };
    bounds.tilt = std::max(bounds.tilt, std::atan(std::hypot(steepest(1), steepest(2))));
  }
  bounds.tilt *= 180 / std::numbers::pi;
  const int columns = std::max(2, static_cast<int>(std::min(2 * front / kBellyCell, 12.0)));
  const int rows = std::max(2, static_cast<int>(std::min(2 * side / kBellyCell, 12.0)));
  const double half_x = front / columns, half_y = side / rows;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      const double x = -front + (2 * i + 1) * half_x, y = -side + (2 * j + 1) * half_y;
      const auto range =
          terrain((pose * localization::Pose2{x, y, 0}).at(), std::hypot(half_x, half_y) + position_error);
      if (!range) return {};
      for (const PlaneOfSupports& plane : planes)
        for (const double u : {-half_x, half_x})
          for (const double v : {-half_y, half_y}) {
            // The plane is linear, so its least height over a square is at a corner.
            const Eigen::RowVectorXd weights = plane.from_heights.row(0) +
                                               (x + u) * plane.from_heights.row(1) +
                                               (y + v) * plane.from_heights.row(2);
            const double low = weighted(weights, plane, wheels).low;
            bounds.belly =
                std::min(bounds.belly, low + vehicle.belly_clearance.value - range->high - height_error);
          }
    }
  return bounds;
}

}  // namespace waymark::planning
