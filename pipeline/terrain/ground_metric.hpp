// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>
#include "core/grid.hpp"
#include "core/units.hpp"
#include "geo/georeference.hpp"
#include "pipeline/terrain/grid_point.hpp"
namespace waymark::pipeline {

// Distances between cells of a grid. A search ranks millions of cells by `squared` (a straight line through
// the body, two table look-ups), skips blocks by `lower_bound`, and calls `distance` only for the remaining
// candidates.
// Each metric has the same members:
//   Origin origin(column, row)              the cell that distances are measured from
//   double squared(Origin, column, row)     m2; ordered as `distance` up to the slack
//   double lower_bound(Origin, Window)      m2; at most `squared` of every cell in the window
//   double slack(double metres)             a cell farther than the nearest by more cannot be nearest
//   double distance(GridPoint, GridPoint)           metres, exact
//   Eigen::Vector3d position(GridPoint)         Cartesian, metres; agrees with `squared`
//   double cell_diagonal()                  metres, an upper bound for all cells

/// Geodesic distances on the body's ellipsoid for geographic grids. Heights above it are ignored, as in
/// published isolations.
class GeographicMetric {
 public:
  explicit GeographicMetric(const GridGeometry& grid);

  struct Origin {
    std::int64_t column, row;
    double radius, axis;
  };
  Origin origin(std::int64_t column, std::int64_t row) const {
    return {column, row, parallel(row).radius, parallel(row).axis};
  }
  double squared(const Origin& o, std::int64_t column, std::int64_t row) const {
    const Parallel& p = parallel(row);
    const double dr = o.radius - p.radius, dz = o.axis - p.axis;
    return dr * dr + dz * dz + 4 * o.radius * p.radius * half_sine_squared(column - o.column);
  }
  double lower_bound(const Origin& o, const Window& cells) const;
  double slack(double metres) const;
  double distance(GridPoint a, GridPoint b) const;
  Eigen::Vector3d position(GridPoint p) const;
  double cell_diagonal() const;

 private:
  struct Parallel {
    double radius, axis;  // distances from and along the body's axis, metres
  };
  const Parallel& parallel(std::int64_t row) const { return parallels_[static_cast<std::size_t>(row + 1)]; }
  double half_sine_squared(std::int64_t columns_apart) const {
    return half_sines_[static_cast<std::size_t>(columns_apart < 0 ? -columns_apart : columns_apart)];
  }
  Parallel parallel_at(double latitude) const;

  Georeference where_;
  Geodesic geodesic_;
  std::vector<Parallel> parallels_;  // rows -1 to rows
  std::vector<double> half_sines_;   // sin^2 of half the longitude between columns
};

/// Straight lines on the map, in metres.
class PlanarMetric {
 public:
  explicit PlanarMetric(const GridGeometry& grid)
      : cell_width_(grid.where.dx * grid.where.crs.metres_per_unit()),
        cell_height_(grid.where.dy * grid.where.crs.metres_per_unit()) {}

  struct Origin {
    std::int64_t column, row;
  };
  Origin origin(std::int64_t column, std::int64_t row) const { return {column, row}; }
  double squared(const Origin& o, std::int64_t column, std::int64_t row) const {
    const double x = static_cast<double>(column - o.column) * cell_width_;
    const double y = static_cast<double>(row - o.row) * cell_height_;
    return x * x + y * y;
  }
  double lower_bound(const Origin& o, const Window& cells) const;
  double slack(double metres) const { return 1e-12 * metres; }
  double distance(GridPoint a, GridPoint b) const { return (position(a) - position(b)).norm(); }
  Eigen::Vector3d position(GridPoint p) const { return {p.column * cell_width_, p.row * cell_height_, 0}; }
  double cell_diagonal() const { return position({1, 1}).norm(); }

 private:
  double cell_width_, cell_height_;
};

/// Geodesic distances on a projected grid. Cartesian positions are exact on a lattice of every 16th cell
/// (fewer on grids of more than 67 M cells) and interpolated between. At most 20 MB.
class ProjectedMetric {
 public:
  explicit ProjectedMetric(const GridGeometry& grid);
  ~ProjectedMetric();

  struct Origin {
    Eigen::Vector3d position;
  };
  Origin origin(std::int64_t column, std::int64_t row) const {
    return {position({static_cast<double>(column), static_cast<double>(row)})};
  }
  double squared(const Origin& o, std::int64_t column, std::int64_t row) const {
    return (position({static_cast<double>(column), static_cast<double>(row)}) - o.position).squaredNorm();
  }
  double lower_bound(const Origin& o, const Window& cells) const;
  double slack(double metres) const;
  double distance(GridPoint a, GridPoint b) const;
  Eigen::Vector3d position(GridPoint p) const;
  double cell_diagonal() const { return cell_diagonal_; }

 private:
  struct Projection;
  struct Ball {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = 0;
  };
  Eigen::Vector3d to_cartesian(LonLat p) const;
  LonLat lon_lat(GridPoint p) const;
  void build_lattice();
  void measure_interpolation();
  void build_balls();

  GridGeometry grid_;
  Geodesic geodesic_;
  std::unique_ptr<Projection> projection_;
  std::int64_t stride_;             // cells between nodes
  Grid<Eigen::Vector3d> lattice_;   // node (i, j) is cell (stride i, stride j)
  std::vector<Grid<Ball>> balls_;   // level 0: between four nodes; each next level holds 2 x 2
  double interpolation_error_ = 0;  // metres
  double cell_diagonal_ = 0;        // metres
};

}  // namespace waymark::pipeline
