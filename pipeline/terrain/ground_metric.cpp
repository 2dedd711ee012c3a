// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/ground_metric.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::pipeline {
namespace {

double clamp_to(double v, std::int64_t first, std::int64_t end) {
  return std::clamp(v, static_cast<double>(first), static_cast<double>(end - 1));
}

}  // namespace

// ---- planar
// -------------------------------------------------------------------------------------------------

double PlanarMetric::lower_bound(const Origin& o, const Window& cells) const {
  const double x = clamp_to(static_cast<double>(o.column), cells.column, cells.end_column());
  const double y = clamp_to(static_cast<double>(o.row), cells.row, cells.end_row());
  return squared(o, static_cast<std::int64_t>(x), static_cast<std::int64_t>(y));
}

// ---- geographic
// ---------------------------------------------------------------------------------------------

GeographicMetric::GeographicMetric(const GridGeometry& grid)
    : where_(grid.where), geodesic_(grid.where.crs.body()) {
  for (std::int64_t r = -1; r <= grid.rows; ++r)
    parallels_.push_back(parallel_at(std::clamp(where_.y(static_cast<double>(r)), -90.0, 90.0)));
  for (std::int64_t c = 0; c <= grid.columns + 1; ++c) {
    const double s = std::sin(static_cast<double>(c) * where_.dx * kRadiansPerDegree / 2);
    half_sines_.push_back(s * s);
  }
}

GeographicMetric::Parallel GeographicMetric::parallel_at(double latitude) const {
  const Body& body = where_.crs.body();
  const double e2 = body.flattening * (2 - body.flattening);
  const double sine = std::sin(latitude * kRadiansPerDegree), cosine = std::cos(latitude * kRadiansPerDegree);
  const double normal = body.equatorial_radius / std::sqrt(1 - e2 * sine * sine);
  return {std::max(0.0, normal * cosine), normal * (1 - e2) * sine};
}

// At equal longitude the nearest parallel is nearest in latitude; at equal latitudes the nearest meridian is
// nearest in longitude. Longitude has the least effect on the shortest parallel.
double GeographicMetric::lower_bound(const Origin& o, const Window& cells) const {
  const auto row = std::clamp(o.row, cells.row, cells.end_row() - 1);
  const Parallel& near = parallel(row);
  const double dr = o.radius - near.radius, dz = o.axis - near.axis;
  const double shortest = std::min(parallel(cells.row).radius, parallel(cells.end_row() - 1).radius);
  double apart = 0;
  if (o.column < cells.column || o.column >= cells.end_column())  // beyond half a turn the distance decreases
    apart = std::min(half_sine_squared(cells.column - o.column),
                     half_sine_squared(cells.end_column() - 1 - o.column));
  return dr * dr + dz * dz + 4 * o.radius * shortest * apart;
}

// A geodesic of length s and its chord c differ by c^3 / (24 R^2); R varies by at most 3 f with position and
// azimuth. 1e-6 m covers the rounding of chords between neighbouring cells.
double GeographicMetric::slack(double metres) const {
  const Body& body = where_.crs.body();
  const double fraction = std::min(1.0, metres / body.equatorial_radius);
  return metres * (3 * body.flattening * fraction * fraction + 1e-9) + 1e-6;
}

double GeographicMetric::distance(GridPoint a, GridPoint b) const {
  return geodesic_.distance({where_.x(a.column), where_.y(a.row)}, {where_.x(b.column), where_.y(b.row)});
}

double GeographicMetric::cell_diagonal() const {
  const Body& body = where_.crs.body();
  const double largest_radius = body.equatorial_radius / (1 - body.flattening);  // of curvature, at the poles
  return 1.001 * largest_radius * std::hypot(where_.dx, where_.dy) * kRadiansPerDegree;
}

Eigen::Vector3d GeographicMetric::position(GridPoint p) const {
  const Parallel at = parallel_at(std::clamp(where_.y(p.row), -90.0, 90.0));
  const double longitude = where_.x(p.column) * kRadiansPerDegree;
  return {at.radius * std::cos(longitude), at.radius * std::sin(longitude), at.axis};
}

}  // namespace waymark::pipeline
