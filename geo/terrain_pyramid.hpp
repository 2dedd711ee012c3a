// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>
#include "geo/terrain.hpp"
namespace waymark::inline geo {

/// Bilinear height of one cell, a + b u + c v + d u v; u and v in [0, 1] count along columns and rows.
struct Patch {
  double a = 0, b = 0, c = 0, d = 0;

  bool known() const { return std::isfinite(a + b + c + d); }
  double height(double u, double v) const { return a + b * u + (c + d * u) * v; }
};

/// Ray in units of cells: column u + t du, row v + t dv, height z + t dz; t in metres along the ray.
struct GridRay {
  double u = 0, v = 0, z = 0;
  double du = 0, dv = 0, dz = 0;
};

struct RayRange {
  double from = 0, to = 0;
};

struct PyramidHit {
  RayEnd end = RayEnd::sky;
  double t = 0;
};

enum class UnknownCells { stop, pass };

/// Heights, and a pyramid of maxima: of each cell, of each 2 x 2 cells, and so on.
struct Terrain::Pyramid {
  Pyramid(Grid<float> heights, double x0, double y0, double step_x, double step_y, double height_sd);

  struct CellPosition {
    std::int64_t column = 0, row = 0;
    double u = 0, v = 0;  ///< within the cell
  };
  /// Returns the cell of a point; `std::nullopt` outside the extent, whose edges belong to it.
  std::optional<CellPosition> locate(double x, double y) const;
  Patch patch(std::int64_t column, std::int64_t row) const;
  GridRay to_grid_ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& along) const;
  /// Returns the part of the ray within the extent and not above `ceiling`.
  std::optional<RayRange> clip_to_extent(const GridRay& ray) const;
  PyramidHit first_hit(const GridRay& ray, const RayRange& range, UnknownCells unknown) const;

  Grid<float> heights;
  double x0 = 0, y0 = 0, step_x = 1, step_y = 1, height_sd = 0;
  double min_height = 0, max_height = 0;  ///< NaN if all heights are unknown
  double ceiling = 0;                     ///< upper bound of all heights; infinity if all are unknown
  /// levels[k](i, j): upper bound over cells [i 2^k, (i + 1) 2^k) x [j 2^k, (j + 1) 2^k).
  std::vector<Grid<float>> levels;
};

}  // namespace waymark::inline geo
