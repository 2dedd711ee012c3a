// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>
namespace waymark::pipeline {

/// Half side of the square correlation window, nodes: 7 x 7.
inline constexpr int kWindowMargin = 3;

/// Two views whose windows are compared.
struct ViewPair {
  std::size_t first = 0, second = 0;
  double angle = 0;  ///< between their rays, radians
};

/// Brightness of a view resampled to the nodes of a surface; NaN where it is not seen. (x, y), x fastest.
using Resampled = Eigen::ArrayXXf;

/// Correlations of the windows around the nodes, without a margin of kWindowMargin on each side.
struct WindowScores {
  std::vector<Eigen::ArrayXXf> pairs;  ///< ZNCC per pair, [-1, 1]; NaN where a view has no texture or no data
  Eigen::ArrayXXf textured;            ///< number of views whose window has texture
  Eigen::ArrayXXf complete;            ///< number of views that see the whole window
};

/// Computes zero-mean normalized cross-correlations of 7 x 7 windows. A window has texture if its standard
/// deviation exceeds `min_sd` of its view. Cost: about 30 operations per node and pair.
WindowScores correlate_windows(std::span<const Resampled> views, std::span<const double> min_sd,
                               std::span<const ViewPair> pairs);

/// Returns the mean of the largest values that are not NaN: a fraction of them, rounded up; NaN if there are
/// none. Reorders `values`.
float mean_of_largest(std::span<float> values, double fraction);

}  // namespace waymark::pipeline
