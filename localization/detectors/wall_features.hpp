// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>
#include "localization/detectors/wall_lines.hpp"
namespace waymark::localization {

/// Options of the search for corners, ends and doors of walls.
struct WallFeatureOptions {
  double max_gap = 0.35;                        ///< m between the intersection of two walls and their ends
  double min_corner = 0.87, max_corner = 2.27;  ///< rad between two walls
  double min_free = 0.4;                        ///< m by which the background of an end is farther away
  double min_incidence = 0.26;                  ///< rad between beam and wall at an end
  double min_door = 0.7, max_door = 1.2;        ///< m between two jambs
  double max_offset = 0.1;                      ///< m between the lines of two jambs
  double position_sd = 0.02, angle_sd = 0.01;   ///< m, rad: of walls that are not perfectly straight
};

/// A corner of two walls in the frame of the sensor. Angles are radians from its x axis to the left.
struct WallCorner {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  double direction = 0;      ///< bisector into the open
  double opening_angle = 0;  ///< through the open, above pi for a convex corner
  double direction_variance = 0, opening_variance = 0;
};

/// An end of a wall in the open, in the frame of the sensor.
struct WallEnd {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  double direction = 0;  ///< normal of the seen face
  double direction_variance = 0;
  int side = 0;               ///< 1: the wall lies left of its end as seen by the sensor, -1: right
  std::size_t beam = 0;       ///< outermost beam on the wall
  bool at_last_beam = false;  ///< whether that is the last beam of the wall, not the first
  std::size_t line = 0;       ///< index of its wall
};

/// A gap between two pieces of one wall, in the frame of the sensor.
struct WallDoor {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  double width = 0, width_variance = 0;
  double orientation = 0, orientation_variance = 0;  ///< along the wall
};

/// Returns the corners of neighbouring walls.
std::vector<WallCorner> find_wall_corners(std::span<const WallLine> walls,
                                          const WallFeatureOptions& options = {});

/// Returns the ends of walls before a background that the scan measures. The end lies half a beam beyond the
/// last hit.
std::vector<WallEnd> find_wall_ends(const LaserScan& scan, std::span<const WallLine> walls,
                                    const WallFeatureOptions& options = {});

/// Returns the gaps between ends on one line through which the scan sees.
std::vector<WallDoor> find_doors(const LaserScan& scan, std::span<const WallLine> walls,
                                 const WallFeatureOptions& options = {});

}  // namespace waymark::localization
