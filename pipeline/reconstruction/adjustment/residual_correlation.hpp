// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/grid.hpp"
namespace waymark::pipeline {

/// Correlation of residuals by their distance along rows and columns of a grid.
struct ResidualCorrelation {
  std::vector<double> by_lag = {1};  ///< by cells, up to the first below 0.05; the first is 1

  /// Returns the correlation at a distance in cells, linear between lags; 0 beyond the last.
  double at(double lag) const;
  /// Returns how many known cells share one error: the mean, over the known cells, of the sum of their
  /// correlations with all known ones; 1 without any.
  double shared_cells(const Grid<float>& residuals) const;
};

/// Estimates the correlation of residuals; NaN cells are unknown. Residuals above `limit` are gross and left
/// out.
ResidualCorrelation correlation_of(const Grid<float>& residuals, double limit);

}  // namespace waymark::pipeline
