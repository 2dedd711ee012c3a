// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
#include "geo/image_source.hpp"
#include "geo/sun.hpp"
#include "geo/terrain.hpp"
#include "pipeline/fusion/image_view.hpp"
namespace waymark {

/// Part of a terrain as a grid of means of its cells, and what light would make of it.
struct LitRelief {
  double x0 = 0, y0 = 0;          ///< middle of cell (0, 0), metres
  double step_x = 1, step_y = 1;  ///< rows run south
  Grid<float> height;             ///< NaN where unknown
  /// Cosine between the ground's normal and the sun; NaN where a neighbour is unknown and beside ground
  /// that faces away from it.
  Grid<float> light;

  Eigen::Vector3d at(std::int64_t column, std::int64_t row) const {
    return {x0 + static_cast<double>(column) * step_x, y0 - static_cast<double>(row) * step_y,
            static_cast<double>(height(column, row))};
  }
};

/// The box from `low` to `high` (metres), `cells` x `cells` nodes of the terrain made one.
LitRelief lit_relief(const Terrain& terrain, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                     int cells, const Sun& sun);

/// Without what is coarser than 2 radius + 1 cells: minus the mean of the known cells about each. NaN stays.
Grid<float> fine_part(const Grid<float>& values, int radius);

/// Means of `factor` x `factor` pixels; NaN where one is.
Pixels reduced(const Pixels& pixels, int factor);

}  // namespace waymark
