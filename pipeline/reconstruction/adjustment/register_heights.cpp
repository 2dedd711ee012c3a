// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/register_heights.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "pipeline/reconstruction/adjustment/residual_correlation.hpp"

namespace waymark::pipeline {
namespace {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

constexpr double kCellsOfSearch = 32;      // of both DEMs, across the map
constexpr double kMinReferenceCells = 10;  // of the reference, across the map
constexpr double kMaxCellsAcross = 400;
constexpr double kMinCompared = 0.7;    // of the cells of the map, on the reference
constexpr std::size_t kMinCells = 200;  // compared: fewer show no spread of five parameters

std::vector<Eigen::Vector3d> points_of(const CoarseHeights& dem) {
  std::vector<Eigen::Vector3d> out;
  for (std::int64_t r = 0; r < dem.grid.rows; ++r)
    for (std::int64_t c = 0; c < dem.grid.columns; ++c)
      if (std::isfinite(dem.heights(c, r)))
        out.emplace_back(dem.grid.x(double(c)), dem.grid.y(double(r)), double(dem.heights(c, r)));
  return out;
}

/// Box of points in plan.
struct Extent {
  Eigen::Vector2d low = {}, high = {};
  double side() const { return (high - low).maxCoeff(); }
};

Extent extent_of(const std::vector<Eigen::Vector3d>& points) {
  Extent out{Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()),
             Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity())};
  for (const Eigen::Vector3d& p : points) {
    out.low = out.low.cwiseMin(p.head<2>());
    out.high = out.high.cwiseMax(p.head<2>());
  }
  return out;
}

/// Least squares of the heights of a map above a reference. Parameters refer to the mean of the cells.
class LevelFit {
 public:
  LevelFit(const CoarseHeights& map, const CoarseHeights& reference)
      : map_(map),
        reference_(reference),
        smooth_(with_cell(reference, 4 * reference.grid.cell)),
        points_(points_of(map)),
        above_(map.grid.columns, map.grid.rows) {
    for (const Eigen::Vector3d& p : points_) middle_ += p / double(points_.size());
  }

  /// Refines; returns whether enough cells lie on the reference.
  bool refine(LevelSimilarity& place) {
    for (int iteration = 0; iteration < 60; ++iteration) {
      if (!linearize(place)) return false;
      const Vector5 step = normal_.ldlt().solve(right_);
      if (!step.allFinite()) return false;
      const Eigen::Vector3d pivot = place * middle_ + Eigen::Vector3d(step[0], step[1], step[4]);
      place.yaw += step[2];
      place.log_scale += step[3];
      place.shift.setZero();
      place.lift = 0;
      const Eigen::Vector3d left = pivot - place * middle_;
      place.shift = left.head<2>();
      place.lift = left.z();
      if (step.head<2>().norm() < 1e-5 * reference_.grid.cell && step.segment<2>(2).norm() < 1e-8) break;
    }
    return linearize(place);
  }

  HeightRegistration result(const LevelSimilarity& place) const {
    const Matrix5 inverse = normal_.inverse();
    return {.reference_from_map = place,
            .pivot = place * middle_,
            .covariance = inverse * spread() * inverse,
            .residual = residual_,
            .cells = used_};
  }

 private:
  bool linearize(const LevelSimilarity& place) {
    rows_.clear();
    std::vector<double> sizes;
    const double d = reference_.grid.cell / 2;
    const Eigen::Vector3d pivot = place * middle_;
    above_ = Grid<float>(map_.grid.columns, map_.grid.rows, std::numeric_limits<float>::quiet_NaN());
    for (const Eigen::Vector3d& p : points_) {
      const Eigen::Vector3d at = place * p, arm = at - pivot;
      const double here = reference_.at(at.x(), at.y());
      const double east = reference_.at(at.x() + d, at.y()), west = reference_.at(at.x() - d, at.y());
      const double north = reference_.at(at.x(), at.y() + d), south = reference_.at(at.x(), at.y() - d);
      // Instrument of the scale: its own errors are not those of the compared heights, which would shrink it.
      const double level = smooth_.at(at.x(), at.y()) - pivot.z();
      if (!std::isfinite(here + east + west + north + south + level)) continue;
      const double gx = -(east - west) / (2 * d), gy = -(north - south) / (2 * d);
      Vector5 gradient;
      gradient << gx, gy, -arm.y() * gx + arm.x() * gy, arm.x() * gx + arm.y() * gy + level, 1;
      const auto column = std::llround(map_.grid.column(p.x())), row = std::llround(map_.grid.row(p.y()));
      above_(column, row) = float(at.z() - here);
      rows_.push_back({gradient, at.z() - here, column, row});
      sizes.push_back(std::abs(at.z() - here));
    }
    used_ = rows_.size();
    if (double(used_) < kMinCompared * double(points_.size()) || used_ < kMinCells) return false;
    const auto half = sizes.begin() + std::ptrdiff_t(sizes.size() / 2);
    std::nth_element(sizes.begin(), half, sizes.end());
    const double width = 2 * 1.4826 * *half + 1e-9;
    normal_.setZero();
    right_.setZero();
    double squares = 0, total = 0;
    for (Row& row : rows_) {
      row.weight = 1 / (1 + std::pow(row.above / width, 2));
      normal_ += row.weight * row.gradient * row.gradient.transpose();
      right_ -= row.weight * row.above * row.gradient;
      squares += row.weight * row.above * row.above;
      total += row.weight;
    }
    residual_ = std::sqrt(squares / total);
    return true;
  }

  /// Covariance of the sum of weighted gradients times errors of the correlation of the residuals. Cells are
  /// joined to blocks that are small against the correlation length.
  Matrix5 spread() const {
    const ResidualCorrelation correlation = correlation_of(above_, 3 * residual_);
    const auto reach = static_cast<std::int64_t>(correlation.by_lag.size());
    const std::int64_t block = std::max<std::int64_t>(1, reach / 6);
    const std::int64_t columns = map_.grid.columns / block + 1, rows = map_.grid.rows / block + 1;
    std::vector<Vector5> sums(std::size_t(columns * rows), Vector5::Zero());
    for (const Row& row : rows_)
      sums[std::size_t(row.row / block * columns + row.column / block)] += row.weight * row.gradient;
    const std::int64_t far = reach / block;
    Matrix5 out = Matrix5::Zero();
    double parts = 0;  // cells that share one error
    for (std::int64_t dy = -far; dy <= far; ++dy)
      for (std::int64_t dx = -far; dx <= far; ++dx) {
        const double here = correlation.at(double(block) * std::hypot(double(dx), double(dy)));
        if (here == 0) continue;
        parts += here * double(block * block);
        for (std::int64_t r = std::max<std::int64_t>(0, -dy); r < std::min(rows, rows - dy); ++r)
          for (std::int64_t c = std::max<std::int64_t>(0, -dx); c < std::min(columns, columns - dx); ++c)
            out += here * sums[std::size_t(r * columns + c)] *
                   sums[std::size_t((r + dy) * columns + c + dx)].transpose();
      }
    const double independent = std::max(double(used_) / parts, 6.0);
    return (out + out.transpose()) / 2 * residual_ * residual_ * independent / (independent - 5);
  }

  struct Row {
    Vector5 gradient;
    double above;
    std::int64_t column, row;
    double weight = 1;
  };

  const CoarseHeights& map_;
  const CoarseHeights& reference_;
  CoarseHeights smooth_;
  std::vector<Eigen::Vector3d> points_;
  Grid<float> above_;  // reference
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  Matrix5 normal_ = Matrix5::Zero();
  Vector5 right_ = Vector5::Zero();
  std::vector<Row> rows_;
  double residual_ = 0;
  std::size_t used_ = 0;
};

CoarseHeights coarsened(const CoarseHeights& dem, double cell) {
  return cell > dem.grid.cell ? with_cell(dem, cell) : dem;
}

LevelSimilarity level_part(const Similarity& s) {
  return {.log_scale = std::log(s.scale),
          .yaw = std::atan2(s.rotation(1, 0), s.rotation(0, 0)),
          .shift = s.shift.head<2>(),
          .lift = s.shift.z()};
}

}  // namespace

Eigen::Vector3d LevelSimilarity::operator*(const Eigen::Vector3d& p) const {
  const double scale = std::exp(log_scale), c = std::cos(yaw), s = std::sin(yaw);
  return {scale * (c * p.x() - s * p.y()) + shift.x(), scale * (s * p.x() + c * p.y()) + shift.y(),
          scale * p.z() + lift};
}

HeightRegistrationResult register_heights(const CoarseHeights& map, const CoarseHeights& reference,
                                          const HeightRules& rules) {
  const Extent extent = extent_of(points_of(map));
  if (!(extent.side() > 0)) return {.message = "the map has no heights"};
  if (extent.side() * rules.max_scale < kMinReferenceCells * reference.grid.cell)
    return {.message = fmt::format(
                "the map is {:.3g} m wide, but {:.0f} cells of the reference are {:.3g} m: too coarse to "
                "recognize its relief",
                extent.side(), kMinReferenceCells, kMinReferenceCells * reference.grid.cell)};
  const std::vector<Eigen::Vector3d> nodes = points_of(coarsened(map, extent.side() / kCellsOfSearch));
  Eigen::Vector3d above(0, 0, -std::numeric_limits<double>::infinity());
  for (const Eigen::Vector3d& p : nodes) above.z() = std::max(above.z(), p.z() + extent.side());
  DemPlacementRules placement = rules.placement;
  placement.smallest = extent.side() / rules.max_scale;
  placement.largest = extent.side() * rules.max_scale;
  const DemPlacementResult start =
      place_on_dem({.points = nodes, .centres = {&above, 1}, .up = Eigen::Vector3d::UnitZ()},
                   coarsened(reference, extent.side() / rules.max_scale / kCellsOfSearch), placement);
  if (!start.found) return {.message = start.message};

  LevelSimilarity place = level_part(start.found->map_from_frame);
  const double scale = std::exp(place.log_scale);
  const double cell =
      std::max({reference.grid.cell, map.grid.cell * scale, extent.side() * scale / kMaxCellsAcross});
  const CoarseHeights compared = coarsened(reference, cell);
  const CoarseHeights own = coarsened(map, cell / scale);
  LevelFit fit(own, compared);
  if (!fit.refine(place) || std::abs(place.log_scale) > std::log(rules.max_scale) + 0.05)
    return {.message = fmt::format(
                "at the best place, less than {:.0f} % of the map's cells have heights in the reference",
                100 * kMinCompared)};
  HeightRegistration found = fit.result(place);
  found.relief = start.found->relief;
  found.next_best_residual = start.found->next_best_residual;
  return {.found = found};
}

}  // namespace waymark::pipeline
