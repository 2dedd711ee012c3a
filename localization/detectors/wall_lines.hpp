// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
#include "localization/laser_scan.hpp"
namespace waymark::localization {

/// Options of the search for straight walls in a scan.
struct WallLineOptions {
  double jump = 0.15, jump_per_metre = 0.03;  ///< m: neighbouring beams that differ more hit two objects
  double tolerance = 0.05;                    ///< m: largest distance of a hit from its line
  double min_length = 0.3;                    ///< m
  std::size_t min_beams = 6;
  double beam_sd = 0.02;  ///< m: smallest standard deviation of a range
};

/// A straight piece of wall in the frame of the sensor, metres.
struct WallLine {
  std::size_t first = 0, last = 0;                    ///< beams
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();   ///< mean of its hits
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();   ///< unit vector from the first end to the last
  Eigen::Vector2d normal = Eigen::Vector2d::UnitY();  ///< unit vector to the side of the sensor
  double begin = 0, end = 0;                          ///< ends, m along the line from the centre
  double centre_variance = 0;                         ///< m^2, across the line at the centre
  double angle_variance = 0;                          ///< rad^2, independent of the former

  double length() const { return end - begin; }
  Eigen::Vector2d at(double s) const { return centre + s * along; }
  /// Returns the variance across the line, m^2, `s` metres from the centre.
  double variance_at(double s) const { return centre_variance + s * s * angle_variance; }
};

/// Finds the straight walls of a scan, in the order of the beams: split and merge (Nguyen et al. 2007).
/// - The beams are cut where ranges jump; each run is split at the hit farthest from its chord.
/// - Neighbouring pieces of a run are merged while one line fits them, the best fit first.
/// - Lines are fitted by total least squares; the variances follow from the scatter of the hits.
/// 10 us per scan of 180 beams.
std::vector<WallLine> find_wall_lines(const LaserScan& scan, const WallLineOptions& options = {});

/// Limits within which pieces are of one wall: its deviations from a straight line, rad and m.
constexpr double kMaxPieceTurn = 0.04, kMaxPieceOffset = 0.08;

/// Joins the pieces that lie on one line, whatever is between them: a wall with doors is one line. Pieces are
/// of one line within `max_turn` rad and `max_offset` m. Longest first; of the hits their moments are used.
std::vector<WallLine> join_collinear(std::vector<WallLine> walls, double max_turn = kMaxPieceTurn,
                                     double max_offset = kMaxPieceOffset);

}  // namespace waymark::localization
