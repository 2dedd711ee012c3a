// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/wall_features.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "localization/detectors/scan_segments.hpp"

namespace waymark::localization {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double angle_of(const Eigen::Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

std::optional<WallCorner> corner_of(const WallLine& a, const WallLine& b, const WallFeatureOptions& options) {
  const double sine = cross(a.along, b.along);
  const double turn = std::acos(std::clamp(-a.along.dot(b.along), -1.0, 1.0));  // between the walls
  if (!(turn >= options.min_corner && turn <= options.max_corner)) return {};
  const double s = cross(b.centre - a.centre, b.along) / sine;  // of the intersection, along a
  WallCorner corner;
  corner.at = a.at(s);
  const double t = b.along.dot(corner.at - b.centre);
  if (!(std::abs(s - a.end) <= options.max_gap && std::abs(t - b.begin) <= options.max_gap)) return {};
  // Both lines fix the corner across themselves: n' p = c, with the variance of each line there.
  const Eigen::Vector2d by_a = b.along / cross(a.along, b.along), by_b = a.along / cross(b.along, a.along);
  corner.covariance = a.variance_at(s) * by_a * by_a.transpose() +
                      b.variance_at(t) * by_b * by_b.transpose() +
                      options.position_sd * options.position_sd * Eigen::Matrix2d::Identity();
  const bool convex = a.normal.dot(b.along) < 0;
  const Eigen::Vector2d inside = b.along - a.along;
  corner.direction = angle_of(convex ? Eigen::Vector2d(-inside) : inside);
  corner.opening_angle = convex ? 2 * std::numbers::pi - turn : turn;
  const double floor = options.angle_sd * options.angle_sd;
  corner.opening_variance = a.angle_variance + b.angle_variance + 2 * floor;
  corner.direction_variance = corner.opening_variance / 4;
  return corner;
}

bool is_corner_end(std::span<const WallLine> walls, std::size_t i, bool last,
                   const WallFeatureOptions& options) {
  if (last) return i + 1 < walls.size() && corner_of(walls[i], walls[i + 1], options);
  return i > 0 && corner_of(walls[i - 1], walls[i], options);
}

std::optional<WallEnd> end_of(const LaserScan& scan, const WallLine& wall, bool last,
                              const WallFeatureOptions& options) {
  const std::size_t beam = last ? wall.last : wall.first;
  if (last ? beam + 1 >= scan.ranges.size() : beam == 0) return {};
  const Eigen::Vector2d hit = wall.at(last ? wall.end : wall.begin);
  const double range = hit.norm(), behind = range_of(scan, last ? beam + 1 : beam - 1);
  if (!(range > 0.05) || !std::isfinite(behind) || !(behind >= range + options.min_free)) return {};
  const double sine = -wall.normal.dot(hit) / range;  // of the incidence
  if (!(sine >= std::sin(options.min_incidence))) return {};
  const double spacing = std::abs(scan.angle_step) * range / sine;
  const Eigen::Vector2d outwards = last ? wall.along : Eigen::Vector2d(-wall.along);
  WallEnd end;
  end.at = hit + spacing / 2 * outwards;
  const double floor = options.position_sd * options.position_sd;
  const double across = wall.variance_at(last ? wall.end : wall.begin) + floor;
  end.covariance = across * wall.normal * wall.normal.transpose() +
                   (spacing * spacing / 12 + floor) * wall.along * wall.along.transpose();
  end.direction = angle_of(wall.normal);
  end.direction_variance = wall.angle_variance + options.angle_sd * options.angle_sd;
  end.side = last == (scan.angle_step > 0) ? -1 : 1;
  end.beam = beam;
  end.at_last_beam = last;
  return end;
}

// Returns whether all beams between two jambs pass the line through both.
bool sees_through(const LaserScan& scan, const WallEnd& right, const WallEnd& left, double min_free) {
  const Eigen::Vector2d across = left.at - right.at;
  for (std::size_t i = right.beam + 1; i < left.beam; ++i) {
    const double angle = scan.first_angle + static_cast<double>(i) * scan.angle_step;
    const Eigen::Vector2d beam(std::cos(angle), std::sin(angle));
    const double sine = cross(beam, across);
    if (std::abs(sine) < 1e-9) return false;
    if (!(range_of(scan, i) >= cross(right.at, across) / sine + min_free)) return false;
  }
  return true;
}

}  // namespace

std::vector<WallCorner> find_wall_corners(std::span<const WallLine> walls,
                                          const WallFeatureOptions& options) {
  std::vector<WallCorner> corners;
  for (std::size_t i = 0; i + 1 < walls.size(); ++i)
    if (const auto corner = corner_of(walls[i], walls[i + 1], options)) corners.push_back(*corner);
  return corners;
}

std::vector<WallEnd> find_wall_ends(const LaserScan& scan, std::span<const WallLine> walls,
                                    const WallFeatureOptions& options) {
  std::vector<WallEnd> ends;
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (const bool last : {false, true}) {
      if (is_corner_end(walls, i, last, options)) continue;
      std::optional<WallEnd> end = end_of(scan, walls[i], last, options);
      if (!end) continue;
      end->line = i;
      ends.push_back(*end);
    }
  return ends;
}

std::vector<WallDoor> find_doors(const LaserScan& scan, std::span<const WallLine> walls,
                                 const WallFeatureOptions& options) {
  const std::vector<WallEnd> ends = find_wall_ends(scan, walls, options);
  std::vector<WallDoor> doors;
  for (const WallEnd& right : ends)  // the names are those of beams from right to left
    for (const WallEnd& left : ends) {
      if (!right.at_last_beam || left.at_last_beam || left.beam <= right.beam) continue;
      const WallLine &a = walls[right.line], &b = walls[left.line];
      const Eigen::Vector2d across = left.at - right.at;
      const double width = across.norm();
      if (!(width >= options.min_door && width <= options.max_door)) continue;
      if (!(std::abs(a.normal.dot(across)) <= options.max_offset &&
            std::abs(b.normal.dot(across)) <= options.max_offset) ||
          a.normal.dot(b.normal) < 0 || !sees_through(scan, right, left, options.min_free))
        continue;
      WallDoor door;
      door.at = (right.at + left.at) / 2;
      door.covariance = (right.covariance + left.covariance) / 4;
      door.width = width;
      door.width_variance = a.along.dot((right.covariance + left.covariance) * a.along);
      door.orientation = angle_of(across);
      door.orientation_variance =
          a.normal.dot((right.covariance + left.covariance) * a.normal) / (width * width);
      doors.push_back(door);
    }
  return doors;
}

}  // namespace waymark::localization
