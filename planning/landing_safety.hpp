// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "core/grid.hpp"
namespace waymark::planning {

/// Where a lander touches down about its aim: a Gaussian error.
struct LandingError {
  double major = 0, minor = 0;  ///< metres, standard deviations along the axes; major >= minor > 0
  double azimuth = 0;           ///< degrees, of the major axis, clockwise from grid north
};

/// Returns the covariance in cells: columns to the east, rows to the south.
Eigen::Matrix2d covariance_in_cells(const LandingError& error, double cell_x, double cell_y);

/// Returns the cells to each side that the blur reads: four standard deviations and one cell.
struct LandingMargin {
  std::int64_t columns = 0, rows = 0;
};
LandingMargin landing_margin(const Eigen::Matrix2d& covariance);

/// Returns the probability of a safe touchdown for an aim at each cell of `inner`: `safe`, the probability
/// that a cell is safe, averaged over the Gaussian (ALHAT; Ivanov et al. 2013). NaN counts as unsafe.
/// - `safe` covers `inner` with the margin; `inner` is relative to it.
/// - A Gaussian is a blur along rows and one along a slanted line (Geusebroek et al. 2003); narrow ones are
///   summed directly. Differs from landing_safety_directly() by less than 0.005.
Grid<float> landing_safety(const Grid<float>& safe, const Window& inner, const Eigen::Matrix2d& covariance);

/// Computes the same sum directly, for every offset within the margin.
Grid<float> landing_safety_directly(const Grid<float>& safe, const Window& inner,
                                    const Eigen::Matrix2d& covariance);

}  // namespace waymark::planning
