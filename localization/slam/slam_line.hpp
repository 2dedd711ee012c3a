// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>
#include "localization/filters/measurement.hpp"
#include "localization/identification/map_landmark.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// A piece of a line that was sighted. Its deviation from the line is the same in each sighting of it: two
/// unknowns, m at its middle and rad, as a sighting measures them.
struct LinePiece {
  double from = 0, to = 0;  ///< m from the anchor, to the left of the normal
  std::size_t slot = 0;     ///< of the deviation, in SlamState or PoseGraph

  double middle() const { return (from + to) / 2; }
  double length() const { return to - from; }
};

/// Returns the correlation of the mean deviations of two pieces of a line whose deviations along it are
/// white: the part that they share.
double deviation_correlation(const LinePiece& a, const LinePiece& b);

/// Frame of a straight line, such as a wall, near which SLAM knows it by two numbers: metres from the anchor
/// along the normal, and radians by which the normal is turned to the left of `normal`. The position along
/// the line is not known, so it is no unknown (docs/decisions/0038).
struct SlamLine {
  Eigen::Vector2d anchor = Eigen::Vector2d::Zero();   ///< m, in the map
  Eigen::Vector2d normal = Eigen::Vector2d::UnitY();  ///< unit vector to the side from which it is seen
  double from = 0, to = 0;    ///< ends of what was seen, m from the anchor, to the left of the normal
  std::size_t direction = 0;  ///< feature of its type that is the direction of the normal
  std::size_t length = 0;     ///< feature of its type that is the length
  std::vector<LinePiece> pieces = {};  ///< sighted, those seen last at the end
};

/// Returns the frame of a line of the map, with its middle as the anchor.
SlamLine slam_line(const MapLandmark& landmark, const LineFeatures& features);

/// Returns the covariance of the two numbers of a line of the map.
Eigen::Matrix2d line_covariance(const MapLandmark& landmark);

/// Returns the frame of a sighted line, with the centre of its piece as the anchor: there the errors of
/// distance and direction are independent. `sensor`: in the map.
SlamLine slam_line(const SeenLandmark& seen, const Pose2& sensor, const LineFeatures& features);

/// Returns the distance of the sensor from a line, m, and the direction of its normal from the sensor's x
/// axis, rad, with the derivatives. `state`: the two numbers of the line.
ExpectedSighting expect(const Pose2& robot, const Pose2& robot_from_sensor, const SlamLine& line,
                        const Eigen::Vector2d& state);

/// Returns measured minus expected distance and direction of a sighted line.
Eigen::Vector2d line_innovation(const SeenLandmark& seen, const SlamLine& line,
                                const Eigen::Vector2d& expected);

/// Returns the measured distance, m, and direction of the normal, rad, of a sighted line.
Eigen::Vector2d line_measurement(const SeenLandmark& seen, const SlamLine& line);

/// Returns the noise of distance and direction, which are correlated: the distance is that of the foot of the
/// sensor, and a turn of the line about the centre of the piece moves the foot.
Eigen::Matrix2d line_noise(const SeenLandmark& seen, const SlamLine& line);

/// Returns the piece of a line that is sighted from `sensor`.
LinePiece sighted_piece(const SlamLine& line, const Eigen::Vector2d& state, const LineExtent& seen,
                        const Eigen::Vector2d& sensor);

/// Returns whether pieces of a sighted line may deviate from it.
bool has_deviations(const LineExtent& seen);

/// Returns the piece that deviates like another one; end() if none shares more than half with it: the others
/// say nothing about its deviation.
std::vector<LinePiece>::iterator find_piece(std::vector<LinePiece>& pieces, const LinePiece& now);

/// What the deviation of a piece adds to a sighting.
struct PieceDeviation {
  Eigen::Matrix2d by_deviation;  ///< derivative of the sighting
  Eigen::Matrix2d covariance;    ///< of the deviation
};
/// Returns it for a sighting of `now`, which deviates like `piece`.
PieceDeviation piece_deviation(const LineExtent& seen, const LinePiece& piece, const LinePiece& now);

/// Returns the ends of a line from the foot of the sensor on it, m to the left of the normal.
LineExtent extent_from_foot(const SlamLine& line, const Eigen::Vector2d& state,
                            const Eigen::Vector2d& sensor);

/// Extends a line by the piece that was seen from `sensor`.
void extend(SlamLine& line, const Eigen::Vector2d& state, const LineExtent& seen,
            const Eigen::Vector2d& sensor);

/// A line as a landmark of a map: the middle of what was seen, with a covariance that is long along it, and
/// the azimuth of its normal.
struct LinePosition {
  Eigen::Vector2d at;
  Eigen::Matrix2d covariance;
  double azimuth = 0, azimuth_variance = 0;
};
LinePosition line_position(const SlamLine& line, const Eigen::Vector2d& state,
                           const Eigen::Matrix2d& covariance);

}  // namespace waymark::localization
