// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
#include "localization/laser_scan.hpp"
namespace waymark::localization {

/// Options of the detector of kerbs in 3-D scans.
struct CloudCurbOptions {
  double max_range = 15;                    ///< m: farther away the rows of a scanner are too far apart
  double min_step = 0.05, max_step = 0.25;  ///< m
  double min_length = 3;                    ///< m
  int min_columns = 8;                      ///< directions in which the step is seen
  double max_gap = 3;                       ///< m along it without a step: parked cars hide more
};

/// A step up between two level surfaces along a straight line, in the frame of the scanner, metres.
struct CloudCurb {
  Eigen::Vector2d centre;                          ///< on the face
  Eigen::Vector2d normal;                          ///< unit vector to the lower surface, where the scanner is
  double begin = 0, end = 0;                       ///< ends along along(), from the centre
  double centre_variance = 0, angle_variance = 0;  ///< m^2 across it, rad^2; independent
  double step = 0;                                 ///< height of the upper surface above the lower one
  int columns = 0;                                 ///< directions in which it is seen

  /// Returns the unit vector along it, to the left of its normal.
  Eigen::Vector2d along() const { return {-normal.y(), normal.x()}; }
};

/// Detects kerbs whose face is turned to the scanner.
/// - In each direction of half a degree the points near the ground are a profile of heights over range. A
/// step lies
///   between two level pieces of it.
/// - Straight lines are taken from the steps one by one, that of the most steps first.
/// The result does not depend on the order of the points. 5 ms for 125,000 points.
std::vector<CloudCurb> find_curbs(const PointCloud& cloud, const CloudCurbOptions& options = {});

}  // namespace waymark::localization
