// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "localization/laser_scan.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Options of the detector of upright poles in 3-D scans.
struct CloudPoleOptions {
  double max_range = 40;    ///< m
  double min_height = 0.8;  ///< m from the lowest to the highest point of the pole that is seen
  double max_base = 2;      ///< m above the ground of that lowest point: what stands before it hides the rest
  double max_diameter = 0.7;  ///< m
  double clear = 0.8;         ///< m from its axis within which nothing else stands beside it
  int min_points = 6;
};

/// An upright pole in a 3-D scan, in the frame of the scanner.
struct CloudPole {
  Eigen::Vector2d at;  ///< of the axis, m
  Eigen::Matrix2d covariance;
  double diameter = 0, diameter_sd = 0;  ///< m
  double base = 0, top = 0;              ///< m above the ground: lowest and highest point that belongs to it
  int points = 0;
};

/// Detects poles: columns of points that are tall, thin and isolated layer by layer. A bush at the foot or a
/// crown above does not hide the piece between. The circle is fitted to that piece.
/// - A column that nearer things cut off at most elevations is a strip of what stands behind them: no pole.
/// - Sorts the points into cells of 0.2 m; 10 ms for 125,000 points within 40 m.
/// - Of a scanner with few rows a far pole has too few layers: `min_points`.
std::vector<CloudPole> find_poles(const PointCloud& cloud, const CloudPoleOptions& options = {});

}  // namespace waymark::localization
