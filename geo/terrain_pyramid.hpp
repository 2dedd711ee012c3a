// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>
#include "geo/terrain.hpp"
namespace waymark {

/// Bilinear height a + b u + c v + d u v over one cell, u and v in [0, 1] along columns and rows.
struct Patch {
  double a = 0, b = 0, c = 0, d = 0;

  bool known() const { return std::isfinite(a + b + c + d); }
  double height(double u, double v) const { return a + b * u + (c + d * u) * v; }
};

/// A ray in units of cells: column u + t du, row v + t dv, height z + t dz; t in metres along the ray.
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

/// The heights and, above them, the maximum of each cell, of each 2 x 2 cells, and so on.
struct Terrain::Pyramid {
  Pyramid(Grid<float> heights, double x0, double y0, double step_x, double step_y, double height_sd);

  struct Place {
    std::int64_t column = 0, row = 0;
    double u = 0, v = 0;  ///< within the cell
  };
  /// Nothing outside the extent. Its edges belong to it.
  std::optional<Place> locate(double x, double y) const;
  Patch patch(std::int64_t column, std::int64_t row) const;
  GridRay in_cells(const Eigen::Vector3d& origin, const Eigen::Vector3d& along) const;
  /// The part of the ray over the extent and at or below its highest ground.
  std::optional<RayRange> inside(const GridRay& ray) const;
  PyramidHit first_hit(const GridRay& ray, const RayRange& range, UnknownCells unknown) const;

  Grid<float> heights;
  double x0 = 0, y0 = 0, step_x = 1, step_y = 1, height_sd = 0;
  double lowest = 0, highest = 0;  ///< NaN where nothing is known
  double ceiling = 0;              ///< nothing can stand higher: highest, or infinity
  /// levels[k](i, j): upper bound over cells [i 2^k, (i + 1) 2^k) x [j 2^k, (j + 1) 2^k).
  std::vector<Grid<float>> levels;
};

}  // namespace waymark
