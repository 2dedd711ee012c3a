// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
#include "localization/laser_scan.hpp"
namespace waymark::localization {

/// Options of the detector of facades in 3-D scans.
struct CloudFacadeOptions {
  double max_range = 40;      ///< m
  double min_length = 2;      ///< m along the facade that are seen
  double min_height = 1.2;    ///< m from the lowest to the highest point that is seen
  double min_top = 2.6;       ///< m above the ground: cars are lower
  double min_low_length = 6;  ///< m, of walls that reach less high: vans are shorter
  double min_low_top = 1.6;   ///< m, of those: cars are lower
  double max_rms = 0.06;      ///< m of its points from the plane: hedges are rougher
  double max_through = 0.35;  ///< points seen through it per point on it: fences and trees let pass
  int max_count = 4;          ///< the longest ones: many pieces of a wall are ambiguous
  double min_filled = 0.35;   ///< fraction of its cells of 0.5 m with points
};

/// A vertical plane in a 3-D scan, as a line in the frame of the scanner, metres.
struct CloudFacade {
  Eigen::Vector2d centre;                          ///< mean of its cells
  Eigen::Vector2d normal;                          ///< unit vector to the side of the scanner
  double begin = 0, end = 0;                       ///< ends along along(), from the centre
  double centre_variance = 0, angle_variance = 0;  ///< m^2 across it, rad^2; independent
  double base = 0, top = 0;                        ///< above the ground
  int cells = 0;                                   ///< of 0.25 m, with points on it

  /// Returns the unit vector along it, to the left of its normal.
  Eigen::Vector2d along() const { return {-normal.y(), normal.x()}; }
  double length() const { return end - begin; }
};

/// Detects facades: vertical planes that are tall, long, smooth and closed, by region growing (CGAL
/// Shape_detection; Lafarge & Mallet 2012) over cells of 0.25 m whose points stand upright and flat.
/// - The result does not depend on the order of the points.
/// - Coplanar pieces with less than a metre between them are one facade.
/// - Scanners see little upwards: what ends below `min_top` is taken if it is as long as `min_low_length`.
/// Sides of
///   long trucks are taken for walls.
/// 20 ms for 125,000 points.
std::vector<CloudFacade> find_facades(const PointCloud& cloud, const CloudFacadeOptions& options = {});

}  // namespace waymark::localization
