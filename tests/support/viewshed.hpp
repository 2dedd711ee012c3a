// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "core/units.hpp"
#include "geo/dem_source.hpp"
namespace waymark::test {

/// What a person sees, by ray casting over a small DEM in degrees or metres; curvature included, no
/// refraction.
class Viewshed {
 public:
  explicit Viewshed(const DemSource& dem)
      : grid_(dem.geometry()), heights_(dem.read({0, 0, grid_.columns, grid_.rows})) {
    const Georeference& where = grid_.where;
    radius_ = where.crs.body().mean_radius();
    const bool degrees = where.crs.kind() == CrsKind::geographic;
    const double middle = where.y(static_cast<double>(grid_.rows) / 2) * kRadiansPerDegree;
    cell_height_ =
        degrees ? -where.dy * radius_ * kRadiansPerDegree : -where.dy * where.crs.metres_per_unit();
    cell_width_ = degrees ? where.dx * radius_ * kRadiansPerDegree * std::cos(middle)
                          : where.dx * where.crs.metres_per_unit();
  }

  /// Does an eye 2 m above the ground at one cell see the ground at another?
  bool sees(double column, double row, double to_column, double to_row) const {
    const double dx = (to_column - column) * cell_width_, dy = (to_row - row) * cell_height_;
    const double distance = std::hypot(dx, dy);
    const double eye = height(column, row) + 2, target = height(to_column, to_row) - drop(distance);
    const int steps =
        static_cast<int>(std::ceil(std::max(std::abs(to_column - column), std::abs(to_row - row))));
    for (int i = 1; i < steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      const double ground =
          height(column + t * (to_column - column), row + t * (to_row - row)) - drop(t * distance);
      if (!(ground <= eye + t * (target - eye))) return false;  // voids block the view
    }
    return true;
  }

  /// Share of `samples` places spread evenly over the disc of `range` metres from which a cell is seen; NaN
  /// where more than a tenth of the disc lies outside the DEM.
  double seen_from(std::int64_t column, std::int64_t row, double range, int samples, unsigned seed) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    int inside = 0, seen = 0;
    for (int i = 0; i < samples; ++i) {
      const double distance = range * std::sqrt(unit(random)), azimuth = 2 * std::numbers::pi * unit(random);
      const double c = static_cast<double>(column) + distance * std::sin(azimuth) / cell_width_;
      const double r = static_cast<double>(row) - distance * std::cos(azimuth) / cell_height_;
      if (c < 0 || r < 0 || c > static_cast<double>(grid_.columns - 1) ||
          r > static_cast<double>(grid_.rows - 1))
        continue;
      if (!std::isfinite(height(c, r))) continue;
      ++inside;
      seen += sees(c, r, static_cast<double>(column), static_cast<double>(row));
    }
    return inside < samples * 9 / 10 ? std::nan("") : static_cast<double>(seen) / inside;
  }

 private:
  double height(double column, double row) const {
    const auto c = std::min(static_cast<std::int64_t>(column), grid_.columns - 2);
    const auto r = std::min(static_cast<std::int64_t>(row), grid_.rows - 2);
    const double u = column - static_cast<double>(c), v = row - static_cast<double>(r);
    return (1 - v) * ((1 - u) * heights_(c, r) + u * heights_(c + 1, r)) +
           v * ((1 - u) * heights_(c, r + 1) + u * heights_(c + 1, r + 1));
  }
  double drop(double distance) const { return distance * distance / (2 * radius_); }

  GridGeometry grid_;
  HeightWindow heights_;
  double radius_ = 0, cell_width_ = 0, cell_height_ = 0;
};

/// Rank correlation, in [-1, 1].
inline double spearman(const std::vector<double>& a, const std::vector<double>& b) {
  const auto ranks = [](const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
    std::vector<double> rank(values.size());
    for (std::size_t first = 0, last; first < order.size(); first = last) {
      for (last = first; last < order.size() && values[order[last]] == values[order[first]];) ++last;
      for (std::size_t i = first; i < last; ++i) rank[order[i]] = static_cast<double>(first + last - 1) / 2;
    }
    return rank;
  };
  const auto ra = ranks(a), rb = ranks(b);
  const double n = static_cast<double>(a.size()), mean = (n - 1) / 2;
  double cov = 0, va = 0, vb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    cov += (ra[i] - mean) * (rb[i] - mean);
    va += (ra[i] - mean) * (ra[i] - mean);
    vb += (rb[i] - mean) * (rb[i] - mean);
  }
  return cov / std::sqrt(va * vb);
}

}  // namespace waymark::test
