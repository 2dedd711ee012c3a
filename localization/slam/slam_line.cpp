// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/slam_line.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::localization {
namespace {

constexpr double kMinTurnVariance = 1e-6;  // rad^2: maps and logs may state none

Eigen::Vector2d left_of_normal(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

Eigen::Vector2d normal_at_turn(const SlamLine& line, double turn) {
  return std::cos(turn) * line.normal + std::sin(turn) * left_of_normal(line.normal);
}

}  // namespace

double deviation_correlation(const LinePiece& a, const LinePiece& b) {
  const double shared = std::min(a.to, b.to) - std::max(a.from, b.from);
  return shared > 0 ? shared / std::sqrt(a.length() * b.length()) : 0;
}

SlamLine slam_line(const MapLandmark& landmark, const LineFeatures& features) {
  return {.anchor = landmark.at,
          .normal = landmark.normal,
          .from = -landmark.half_length,
          .to = landmark.half_length,
          .direction = features.direction,
          .length = features.length};
}

Eigen::Matrix2d line_covariance(const MapLandmark& landmark) {
  return Eigen::Vector2d(landmark.normal.dot(landmark.covariance * landmark.normal),
                         std::max(landmark.normal_variance, kMinTurnVariance))
      .asDiagonal();
}

SlamLine slam_line(const SeenLandmark& seen, const Pose2& sensor, const LineFeatures& features) {
  const double angle = sensor.yaw + seen.features.value[features.direction];
  SlamLine line{.direction = features.direction, .length = features.length};
  line.normal = {std::cos(angle), std::sin(angle)};
  line.anchor = sensor.at() - *seen.range * line.normal + seen.extent->centre * left_of_normal(line.normal);
  line.from = seen.extent->from - seen.extent->centre;
  line.to = seen.extent->to - seen.extent->centre;
  return line;
}

ExpectedSighting expect(const Pose2& robot, const Pose2& robot_from_sensor, const SlamLine& line,
                        const Eigen::Vector2d& state) {
  const Pose2 sensor = robot * robot_from_sensor;
  const Eigen::Vector2d lever = sensor.at() - robot.at(), off = sensor.at() - line.anchor;
  const Eigen::Vector2d n = normal_at_turn(line, state[1]);
  ExpectedSighting e;
  e.value << n.dot(off) - state[0], wrap_angle(std::atan2(n.y(), n.x()) - sensor.yaw);
  e.by_landmark << -1, left_of_normal(n).dot(off), 0, 1;
  e.by_pose << n.x(), n.y(), n.dot(left_of_normal(lever)), 0, 0, -1;
  return e;
}

Eigen::Vector2d line_innovation(const SeenLandmark& seen, const SlamLine& line,
                                const Eigen::Vector2d& expected) {
  const Eigen::Vector2d off = line_measurement(seen, line) - expected;
  return {off[0], wrap_angle(off[1])};
}

Eigen::Vector2d line_measurement(const SeenLandmark& seen, const SlamLine& line) {
  return {*seen.range, seen.features.value[line.direction]};
}

Eigen::Matrix2d line_noise(const SeenLandmark& seen, const SlamLine& line) {
  const double distance = seen.range_sd * seen.range_sd,
               turn = std::max(seen.features.variance[line.direction], kMinTurnVariance);
  const double limit = 0.99 * std::sqrt(distance * turn);  // stated noise need not be consistent
  const double both = std::clamp(-seen.extent->centre * turn, -limit, limit);
  Eigen::Matrix2d noise;
  noise << distance, both, both, turn;
  return noise;
}

LinePiece sighted_piece(const SlamLine& line, const Eigen::Vector2d& state, const LineExtent& seen,
                        const Eigen::Vector2d& sensor) {
  const double foot = left_of_normal(normal_at_turn(line, state[1])).dot(sensor - line.anchor);
  return {foot + seen.from, foot + seen.to};
}

bool has_deviations(const LineExtent& seen) {
  return seen.deviation_sd > 0 && seen.deviation_turn_sd > 0;
}

std::vector<LinePiece>::iterator find_piece(std::vector<LinePiece>& pieces, const LinePiece& now) {
  const auto best =
      std::ranges::max_element(pieces, {}, [&](const LinePiece& p) { return deviation_correlation(p, now); });
  return best != pieces.end() && deviation_correlation(*best, now) > 0.5 ? best : pieces.end();
}

PieceDeviation piece_deviation(const LineExtent& seen, const LinePiece& piece, const LinePiece& now) {
  PieceDeviation all;
  const double foot = now.from - seen.from;
  all.by_deviation << 1, foot - piece.middle(), 0, 1;
  all.covariance =
      Eigen::Vector2d(seen.deviation_sd * seen.deviation_sd, seen.deviation_turn_sd * seen.deviation_turn_sd)
          .asDiagonal();
  return all;
}

LineExtent extent_from_foot(const SlamLine& line, const Eigen::Vector2d& state,
                            const Eigen::Vector2d& sensor) {
  const double foot = left_of_normal(normal_at_turn(line, state[1])).dot(sensor - line.anchor);
  return {line.from - foot, line.to - foot};
}

void extend(SlamLine& line, const Eigen::Vector2d& state, const LineExtent& seen,
            const Eigen::Vector2d& sensor) {
  const double foot = left_of_normal(normal_at_turn(line, state[1])).dot(sensor - line.anchor);
  line.from = std::min(line.from, foot + seen.from);
  line.to = std::max(line.to, foot + seen.to);
}

LinePosition line_position(const SlamLine& line, const Eigen::Vector2d& state,
                           const Eigen::Matrix2d& covariance) {
  const Eigen::Vector2d n = normal_at_turn(line, state[1]), along = left_of_normal(n);
  const double middle = (line.from + line.to) / 2, length = line.to - line.from;
  const Eigen::Vector2d by_state(1, -middle);  // of the middle across the line
  return {.at = line.anchor + state[0] * n + middle * along,
          .covariance = by_state.dot(covariance * by_state) * n * n.transpose() +
                        length * length / 12 * along * along.transpose(),
          .azimuth = std::atan2(n.x(), n.y()),
          .azimuth_variance = covariance(1, 1)};
}

}  // namespace waymark::localization
