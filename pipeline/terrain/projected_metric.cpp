// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <mutex>

#include "pipeline/terrain/ground_metric.hpp"

namespace waymark::pipeline {
namespace {

constexpr std::int64_t kFinestStride = 16;   // cells between lattice nodes
constexpr std::int64_t kMaxNodes = 1 << 18;  // 70 bytes each with their balls

// Returns the cells between lattice nodes: more on a grid so large that the lattice would fill the memory.
std::int64_t lattice_stride(const GridGeometry& grid) {
  std::int64_t stride = kFinestStride;
  while ((grid.columns / stride) * (grid.rows / stride) > kMaxNodes) stride *= 2;
  return stride;
}

}  // namespace

struct ProjectedMetric::Projection {
  explicit Projection(const Crs& crs) : to_lon_lat(crs, geographic_crs(crs)) {}
  std::mutex in_use;  // a transform serves one thread at a time
  CrsTransform to_lon_lat;
};

ProjectedMetric::ProjectedMetric(const GridGeometry& grid)
    : grid_(grid),
      geodesic_(grid.where.crs.body()),
      projection_(std::make_unique<Projection>(grid.where.crs)),
      stride_(lattice_stride(grid)) {
  build_lattice();
  measure_interpolation();
  build_balls();
}

ProjectedMetric::~ProjectedMetric() = default;

LonLat ProjectedMetric::lon_lat(GridPoint p) const {
  const std::lock_guard lock(projection_->in_use);
  const auto at = projection_->to_lon_lat(grid_.where.x(p.column), grid_.where.y(p.row));
  return {at.x, at.y};
}

Eigen::Vector3d ProjectedMetric::to_cartesian(LonLat p) const {
  const Body& body = grid_.where.crs.body();
  const double e2 = body.flattening * (2 - body.flattening);
  const double latitude = p.lat * kRadiansPerDegree, longitude = p.lon * kRadiansPerDegree;
  const double normal = body.equatorial_radius / std::sqrt(1 - e2 * std::sin(latitude) * std::sin(latitude));
  return {normal * std::cos(latitude) * std::cos(longitude),
          normal * std::cos(latitude) * std::sin(longitude), normal * (1 - e2) * std::sin(latitude)};
}

void ProjectedMetric::build_lattice() {
  lattice_ = {grid_.columns / stride_ + 2, grid_.rows / stride_ + 2, Eigen::Vector3d::Zero()};
  std::vector<double> x, y;
  for (std::int64_t r = 0; r < lattice_.rows(); ++r)
    for (std::int64_t c = 0; c < lattice_.columns(); ++c) {
      x.push_back(grid_.where.x(static_cast<double>(c * stride_)));
      y.push_back(grid_.where.y(static_cast<double>(r * stride_)));
    }
  projection_->to_lon_lat.apply(x, y);
  for (std::size_t i = 0; i < x.size(); ++i) lattice_.cells()[i] = to_cartesian({x[i], y[i]});
}

// Bilinear interpolation is worst in the middle of four nodes.
void ProjectedMetric::measure_interpolation() {
  std::vector<double> x, y;
  std::vector<Eigen::Vector3d> middle;
  for (std::int64_t r = 0; r + 1 < lattice_.rows(); ++r)
    for (std::int64_t c = 0; c + 1 < lattice_.columns(); ++c) {
      x.push_back(grid_.where.x((static_cast<double>(c) + 0.5) * static_cast<double>(stride_)));
      y.push_back(grid_.where.y((static_cast<double>(r) + 0.5) * static_cast<double>(stride_)));
      middle.push_back((lattice_(c, r) + lattice_(c + 1, r) + lattice_(c, r + 1) + lattice_(c + 1, r + 1)) /
                       4);
    }
  projection_->to_lon_lat.apply(x, y);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double error = (to_cartesian({x[i], y[i]}) - middle[i]).norm();
    if (error > interpolation_error_) interpolation_error_ = error;  // false for the NaN outside a projection
  }
  interpolation_error_ *= 1.5;
}

void ProjectedMetric::build_balls() {
  const Ball none;
  double longest = 0;
  balls_.emplace_back(lattice_.columns() - 1, lattice_.rows() - 1, none);
  for (std::int64_t r = 0; r < balls_[0].rows(); ++r)
    for (std::int64_t c = 0; c < balls_[0].columns(); ++c) {
      Ball& ball = balls_[0](c, r);
      const Eigen::Vector3d corners[] = {lattice_(c, r), lattice_(c + 1, r), lattice_(c, r + 1),
                                         lattice_(c + 1, r + 1)};
      for (const auto& corner : corners) ball.centre += corner / 4;
      for (const auto& corner : corners) ball.radius = std::max((corner - ball.centre).norm(), ball.radius);
      if (c == 0 || r == 0) ball.radius *= 1.25;  // column and row -1 are extrapolated
      if (ball.radius > longest) longest = ball.radius;
    }
  cell_diagonal_ = 1.2 * 2 * longest / static_cast<double>(stride_);
  while (balls_.back().columns() > 1 || balls_.back().rows() > 1) {
    const auto& fine = balls_.back();
    Grid<Ball> coarse((fine.columns() + 1) / 2, (fine.rows() + 1) / 2, none);
    for (std::int64_t r = 0; r < coarse.rows(); ++r)
      for (std::int64_t c = 0; c < coarse.columns(); ++c) {
        std::vector<const Ball*> parts;
        for (const auto& [dc, dr] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}})
          if (fine.contains(2 * c + dc, 2 * r + dr)) parts.push_back(&fine(2 * c + dc, 2 * r + dr));
        Ball& ball = coarse(c, r);
        for (const Ball* part : parts) ball.centre += part->centre / static_cast<double>(parts.size());
        for (const Ball* part : parts)
          ball.radius = std::max((part->centre - ball.centre).norm() + part->radius, ball.radius);
      }
    balls_.push_back(std::move(coarse));
  }
}

Eigen::Vector3d ProjectedMetric::position(GridPoint p) const {
  const std::int64_t i = std::max<std::int64_t>(static_cast<std::int64_t>(p.column), 0) / stride_;
  const std::int64_t j = std::max<std::int64_t>(static_cast<std::int64_t>(p.row), 0) / stride_;
  const double u = (p.column - static_cast<double>(i * stride_)) / static_cast<double>(stride_);
  const double v = (p.row - static_cast<double>(j * stride_)) / static_cast<double>(stride_);
  return (1 - v) * ((1 - u) * lattice_(i, j) + u * lattice_(i + 1, j)) +
         v * ((1 - u) * lattice_(i, j + 1) + u * lattice_(i + 1, j + 1));
}

double ProjectedMetric::lower_bound(const Origin& o, const Window& cells) const {
  std::int64_t i0 = std::max<std::int64_t>(cells.column, 0) / stride_,
               i1 = (cells.end_column() - 1) / stride_;
  std::int64_t j0 = std::max<std::int64_t>(cells.row, 0) / stride_, j1 = (cells.end_row() - 1) / stride_;
  std::size_t level = 0;
  for (; i0 < i1 || j0 < j1; ++level) i0 /= 2, i1 /= 2, j0 /= 2, j1 /= 2;
  const Ball& ball = balls_[level](i0, j0);
  double gap = (o.position - ball.centre).norm() - ball.radius;
  if (level == 0 && cells.columns < stride_ && cells.rows < stride_) {  // a ball of its own is smaller
    const double radius = static_cast<double>(std::max(cells.columns, cells.rows)) / 2 * cell_diagonal_;
    const GridPoint middle{static_cast<double>(cells.column) + static_cast<double>(cells.columns - 1) / 2,
                           static_cast<double>(cells.row) + static_cast<double>(cells.rows - 1) / 2};
    gap = std::max(gap, (o.position - position(middle)).norm() - radius);
  }
  return gap > 0 ? gap * gap : 0;  // also 0 if the block lies outside the projection (NaN)
}

double ProjectedMetric::slack(double metres) const {
  const Body& body = grid_.where.crs.body();
  const double fraction = std::min(1.0, metres / body.equatorial_radius);
  return metres * (3 * body.flattening * fraction * fraction + 1e-9) + 1e-6 + 4 * interpolation_error_;
}

double ProjectedMetric::distance(GridPoint a, GridPoint b) const {
  return geodesic_.distance(lon_lat(a), lon_lat(b));
}

}  // namespace waymark::pipeline
