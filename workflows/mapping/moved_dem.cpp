// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/moved_dem.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace waymark::workflows {
namespace {

class MovedDem final : public DemSource {
 public:
  MovedDem(std::shared_ptr<const DemSource> dem, const MapMove& move, const Crs& crs)
      : dem_(std::move(dem)),
        move_(move),
        scale_(std::exp(move.plane.log_scale)),
        inverse_(move.plane.linear().inverse()),
        from_(metres_of(dem_->geometry().where.crs)),
        to_(metres_of(crs)) {
    const GridGeometry& own = dem_->geometry();
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const double c : {-0.5, double(own.columns) - 0.5})
      for (const double r : {-0.5, double(own.rows) - 0.5}) {
        const Eigen::Vector2d at = move_.plane * (from_ * Eigen::Vector2d(own.where.x(c), own.where.y(r)));
        low = low.cwiseMin(at);
        high = high.cwiseMax(at);
      }
    const double cell = scale_ * from_ * std::min(own.where.dx, -own.where.dy);
    geometry_.columns = std::max<std::int64_t>(1, std::llround((high.x() - low.x()) / cell));
    geometry_.rows = std::max<std::int64_t>(1, std::llround((high.y() - low.y()) / cell));
    geometry_.where = {.crs = crs,
                       .x0 = (low.x() + cell / 2) / to_,
                       .y0 = (high.y() - cell / 2) / to_,
                       .dx = cell / to_,
                       .dy = -cell / to_};
  }

  const GridGeometry& geometry() const override { return geometry_; }
  NodataPolicy nodata_policy() const override { return dem_->nodata_policy(); }
  double height_sd() const override { return scale_ * dem_->height_sd(); }
  std::vector<std::string> files() const override { return dem_->files(); }

  HeightWindow read(const Window& window) const override {
    HeightWindow out(window.columns, window.rows, kNoHeight);
    const GridGeometry& own = dem_->geometry();
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const std::int64_t c : {std::int64_t(0), window.columns - 1})
      for (const std::int64_t r : {std::int64_t(0), window.rows - 1}) {
        const Eigen::Vector2d at = cell_of(window.column + c, window.row + r);
        low = low.cwiseMin(at);
        high = high.cwiseMax(at);
      }
    const auto clipped = [](double v, std::int64_t size) {
      return std::clamp(static_cast<std::int64_t>(std::floor(std::clamp(v, -1.0, double(size)))),
                        std::int64_t(0), size);
    };
    const std::int64_t west = clipped(low.x(), own.columns), north = clipped(low.y(), own.rows);
    const Window source{west, north, std::min(own.columns, clipped(high.x(), own.columns) + 2) - west,
                        std::min(own.rows, clipped(high.y(), own.rows) + 2) - north};
    if (source.columns < 2 || source.rows < 2) return out;
    const HeightWindow heights = dem_->read(source);
    const Window grid{0, 0, geometry_.columns, geometry_.rows};
    for (std::int64_t r = 0; r < window.rows; ++r)
      for (std::int64_t c = 0; c < window.columns; ++c) {
        if (!grid.contains(window.column + c, window.row + r)) continue;
        const Eigen::Vector2d at = cell_of(window.column + c, window.row + r) -
                                   Eigen::Vector2d(double(source.column), double(source.row));
        const auto i = static_cast<std::int64_t>(std::floor(at.x())),
                   j = static_cast<std::int64_t>(std::floor(at.y()));
        if (i < 0 || j < 0 || i + 1 >= source.columns || j + 1 >= source.rows) continue;
        const double a = at.x() - double(i), b = at.y() - double(j);
        const double height = (1 - b) * ((1 - a) * heights(i, j) + a * heights(i + 1, j)) +
                              b * ((1 - a) * heights(i, j + 1) + a * heights(i + 1, j + 1));
        if (std::isfinite(height)) out(c, r) = scale_ * height + move_.lift;
      }
    return out;
  }

 private:
  // Column and row in the source.
  Eigen::Vector2d cell_of(std::int64_t column, std::int64_t row) const {
    const Eigen::Vector2d at(to_ * geometry_.where.x(double(column)), to_ * geometry_.where.y(double(row)));
    const Eigen::Vector2d there = inverse_ * (at - move_.plane.shift) / from_;
    const Georeference& own = dem_->geometry().where;
    return {own.column(there.x()), own.row(there.y())};
  }

  std::shared_ptr<const DemSource> dem_;
  MapMove move_;
  double scale_;
  Eigen::Matrix2d inverse_;
  double from_, to_;  // metres per unit
  GridGeometry geometry_;
};

}  // namespace

std::shared_ptr<const DemSource> moved_dem(std::shared_ptr<const DemSource> dem, const MapMove& move,
                                           const Crs& crs) {
  return std::make_shared<MovedDem>(std::move(dem), move, crs);
}

}  // namespace waymark::workflows
