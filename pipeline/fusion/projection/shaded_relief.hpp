// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
#include "geo/image_source.hpp"
#include "geo/sun.hpp"
#include "geo/terrain.hpp"
#include "pipeline/fusion/projection/image_view.hpp"
namespace waymark::pipeline {

/// Part of a terrain, averaged to coarser cells, with its shading.
struct ShadedRelief {
  double x0 = 0, y0 = 0;          ///< middle of cell (0, 0), metres
  double step_x = 1, step_y = 1;  ///< rows run south
  Grid<float> height;             ///< NaN where unknown
  /// Cosine between surface normal and sun; NaN next to unknown heights and next to ground facing away from
  /// the sun.
  Grid<float> light;

  Eigen::Vector3d at(std::int64_t column, std::int64_t row) const {
    return {x0 + static_cast<double>(column) * step_x, y0 - static_cast<double>(row) * step_y,
            static_cast<double>(height(column, row))};
  }
};

/// Returns the box from `low` to `high` (metres) with `cells` x `cells` nodes of the terrain averaged to one.
ShadedRelief shaded_relief(const Terrain& terrain, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                           int cells, const Sun& sun);

/// Returns the values minus the mean of the known cells within `radius`. NaN stays.
Grid<float> high_pass(const Grid<float>& values, int radius);

/// Returns means of `factor` x `factor` pixels; NaN if one of them is NaN.
Pixels downsample(const Pixels& pixels, int factor);

}  // namespace waymark::pipeline
