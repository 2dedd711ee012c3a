// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/smooth_by_planes.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/solve.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kFirstReach = 3;   // of the planes that give the first slopes, cells
constexpr double kSlopeHold = 0.5;  // weight of the former slopes, in observations of the cell

struct Offset {
  std::int64_t column, row;
  double weight;
};

std::vector<Offset> disc(double reach) {
  std::vector<Offset> offsets;
  const auto k = static_cast<std::int64_t>(std::floor(reach));
  for (std::int64_t j = -k; j <= k; ++j)
    for (std::int64_t i = -k; i <= k; ++i) {
      const auto square = static_cast<double>(i * i + j * j);
      if (square <= reach * reach) offsets.push_back({i, j, 1 - square / ((reach + 1) * (reach + 1))});
    }
  return offsets;
}

// Plane through a cell: height, slopes per column and row; and the variance of its height.
struct CellPlane {
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  double variance = 0;
};

class PlaneRound {
 public:
  PlaneRound(const Grid<float>& heights, const Grid<float>& sd, const Grid<CellPlane>& before, double reach,
             const PlaneSmoothing& rules, bool adaptive)
      : heights_(heights), sd_(sd), before_(before), disc_(disc(reach)), rules_(rules), adaptive_(adaptive) {}

  CellPlane fit(std::int64_t c, std::int64_t r) const {
    const CellPlane& own = before_(c, r);
    const double own_weight = weight_of(c, r);
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const Offset& at : disc_) {
      const std::int64_t i = c + at.column, j = r + at.row;
      if (!heights_.contains(i, j) || std::isnan(heights_(i, j))) continue;
      const Eigen::Vector3d row(1, static_cast<double>(at.column), static_cast<double>(at.row));
      double weight = at.weight * weight_of(i, j);
      if (adaptive_) {
        const double d = before_(i, j).plane.x() - row.dot(own.plane);
        const bool self = at.column == 0 && at.row == 0;
        if (!self)
          weight *= std::max(0.0, 1 - d * d / (rules_.separation * (own.variance + before_(i, j).variance)));
      }
      normal += weight * row * row.transpose();
      right += weight * static_cast<double>(heights_(i, j)) * row;
    }
    const double weights = normal(0, 0);
    for (int k = 1; k < 3; ++k) {
      normal(k, k) += kSlopeHold * own_weight;
      right(k) += kSlopeHold * own_weight * own.plane(k);
    }
    return {solve_symmetric(normal, right), std::min(1 / own_weight, rules_.shared / weights)};
  }

 private:
  double weight_of(std::int64_t c, std::int64_t r) const {
    const auto sd = static_cast<double>(sd_(c, r));
    return 1 / (sd * sd);
  }

  const Grid<float>&heights_, &sd_;
  const Grid<CellPlane>& before_;
  std::vector<Offset> disc_;
  const PlaneSmoothing& rules_;
  bool adaptive_;
};

}  // namespace

Grid<float> smooth_by_planes(const Grid<float>& heights, const Grid<float>& sd, const PlaneSmoothing& rules) {
  Grid<CellPlane> planes(heights.columns(), heights.rows());
  const auto for_known = [&](const auto& use) {
    for (std::int64_t r = 0; r < heights.rows(); ++r)
      for (std::int64_t c = 0; c < heights.columns(); ++c)
        if (!std::isnan(heights(c, r))) use(c, r);
  };
  const auto apply = [&](double reach, bool adaptive) {
    Grid<CellPlane> next = planes;
    const PlaneRound round(heights, sd, planes, reach, rules, adaptive);
    for_known([&](std::int64_t c, std::int64_t r) { next(c, r) = round.fit(c, r); });
    planes = std::move(next);
  };
  apply(kFirstReach, false);
  // The first slopes are kept, but heights start at the measured ones.
  for_known([&](std::int64_t c, std::int64_t r) {
    planes(c, r).plane.x() = static_cast<double>(heights(c, r));
    planes(c, r).variance = static_cast<double>(sd(c, r)) * static_cast<double>(sd(c, r));
  });
  for (const double reach : rules.reach) apply(reach, true);
  Grid<float> smooth = heights;
  for_known(
      [&](std::int64_t c, std::int64_t r) { smooth(c, r) = static_cast<float>(planes(c, r).plane.x()); });
  return smooth;
}

}  // namespace waymark::pipeline
