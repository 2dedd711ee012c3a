// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/depth_rocks.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/grid.hpp"
#include "core/solve.hpp"

namespace waymark::localization {
namespace {

struct Square {
  float lowest = 1e9F, highest = -1e9F;
  int points = 0, segment = -1;
};

// Returns the height of the ground at a cell, from a plane through the lowest points around. Two further
// fits omit what stands above it.
double ground_about(const Grid<Square>& squares, std::int64_t column, std::int64_t row, std::int64_t reach) {
  Eigen::Vector3d plane(0, 0, 0);
  double above = 1e9;
  for (const double keep : {1e9, 0.15, 0.08}) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    int used = 0;
    for (std::int64_t r = std::max<std::int64_t>(0, row - reach);
         r <= std::min(squares.rows() - 1, row + reach); ++r)
      for (std::int64_t c = std::max<std::int64_t>(0, column - reach);
           c <= std::min(squares.columns() - 1, column + reach); ++c) {
        const Square& square = squares(c, r);
        if (square.points == 0) continue;
        const Eigen::Vector3d at(1, double(c - column), double(r - row));
        const double z = double(square.lowest);
        if (above < 1e9 && z - at.dot(plane) > keep) continue;
        normal += at * at.transpose();
        right += at * z;
        ++used;
      }
    if (used < 8) return std::nan("");
    plane = solve_symmetric<3>(normal + 1e-6 * Eigen::Matrix3d::Identity(), right);
    above = keep;
    if (keep == 1e9) above = 0.15;
  }
  return plane(0);
}

/// Extent of what stands above the ground in connected squares.
struct Body {
  double left = -9, right = 9, near = 1e9, top = -1e9;  // bearings, rad; m
  int points = 0;
  bool at_edge = false;
};

/// Points of a depth image, levelled with the robot's heading (x ahead, y left of the camera), in squares of
/// the ground.
class LevelledPoints {
 public:
  LevelledPoints(const DepthImage& image, const DepthRockOptions& options)
      : o_(options), reach_(options.max_range + 2) {
    const auto side = static_cast<std::int64_t>(2 * reach_ / o_.cell);
    squares_ = Grid<Square>(side / 2 + 1, side + 1);
    take(image);
    find_ground();
    for (std::int64_t r = 0; r < squares_.rows(); ++r)
      for (std::int64_t c = 0; c < squares_.columns(); ++c)
        if (stands(c, r) && squares_(c, r).segment < 0) connect(c, r, segments_++);
  }

  /// Returns the bodies that stand above the ground. `edge`: bearing of the side of the image, rad.
  std::vector<Body> bodies(double edge) const {
    std::vector<Body> bodies(static_cast<std::size_t>(segments_));
    for (const Eigen::Vector3d& p : points_) {
      const Square& square = squares_(column_of(p.x()), row_of(p.y()));
      const double above = p.z() - double(ground_(column_of(p.x()), row_of(p.y())));
      if (square.segment < 0 || !(above > 0.5 * o_.min_height)) continue;
      Body& body = bodies[static_cast<std::size_t>(square.segment)];
      const double bearing = std::atan2(p.y(), p.x());
      body.left = std::max(body.left, bearing);
      body.right = std::min(body.right, bearing);
      body.near = std::min(body.near, p.head<2>().norm());
      body.top = std::max(body.top, above);
      ++body.points;
      body.at_edge = body.at_edge || std::abs(bearing) > edge;
    }
    return bodies;
  }

 private:
  std::int64_t column_of(double x) const { return static_cast<std::int64_t>(x / o_.cell); }
  std::int64_t row_of(double y) const { return static_cast<std::int64_t>((y + reach_) / o_.cell); }

  void take(const DepthImage& image) {
    const Eigen::Matrix3d level = (Eigen::AngleAxisd(image.pitch, Eigen::Vector3d::UnitY()) *
                                   Eigen::AngleAxisd(image.roll, Eigen::Vector3d::UnitX()) *
                                   Eigen::AngleAxisd(image.tilt, Eigen::Vector3d::UnitY()))
                                      .toRotationMatrix();
    for (std::int64_t r = 0; r < image.rows; ++r)
      for (std::int64_t c = 0; c < image.columns; ++c) {
        const auto depth = static_cast<double>(image.depths[static_cast<std::size_t>(r * image.columns + c)]);
        if (!(depth > 0) || !std::isfinite(depth)) continue;
        const Eigen::Vector3d p = level * (depth * image.ray(c, r));
        if (!(p.x() > 0 && p.x() < reach_ && std::abs(p.y()) < reach_)) continue;
        Square& square = squares_(column_of(p.x()), row_of(p.y()));
        square.lowest = std::min(square.lowest, static_cast<float>(p.z()));
        square.highest = std::max(square.highest, static_cast<float>(p.z()));
        ++square.points;
        points_.push_back(p);
      }
  }

  void find_ground() {
    const auto around = static_cast<std::int64_t>(o_.around / o_.cell);
    ground_ = Grid<float>(squares_.columns(), squares_.rows(), std::nanf(""));
    for (std::int64_t r = 0; r < squares_.rows(); ++r)
      for (std::int64_t c = 0; c < squares_.columns(); ++c)
        if (squares_(c, r).points > 0)
          ground_(c, r) = static_cast<float>(ground_about(squares_, c, r, around));
  }

  bool stands(std::int64_t c, std::int64_t r) const {
    return squares_(c, r).points > 0 && double(squares_(c, r).highest - ground_(c, r)) > o_.min_height;
  }

  /// Gives a square and all that are connected to it the number of a segment.
  void connect(std::int64_t column, std::int64_t row, int segment) {
    std::vector<std::pair<std::int64_t, std::int64_t>> open{{column, row}};
    squares_(column, row).segment = segment;
    while (!open.empty()) {
      const auto [c, r] = open.back();
      open.pop_back();
      for (std::int64_t nr = r - 1; nr <= r + 1; ++nr)
        for (std::int64_t nc = c - 1; nc <= c + 1; ++nc) {
          if (!squares_.contains(nc, nr) || squares_(nc, nr).segment >= 0 || !stands(nc, nr)) continue;
          squares_(nc, nr).segment = segment;
          open.emplace_back(nc, nr);
        }
    }
  }

  const DepthRockOptions& o_;
  double reach_;
  Grid<Square> squares_;
  Grid<float> ground_;
  std::vector<Eigen::Vector3d> points_;
  int segments_ = 0;
};

std::optional<DepthRock> rock_of(const Body& body, double focal, const DepthRockOptions& options) {
  if (body.points < options.min_points || body.at_edge || body.near > options.max_range) return {};
  const double half_sine = std::sin(std::min(body.left - body.right, 2.0) / 2);
  const double radius = body.near * half_sine / (1 - half_sine);
  if (!(2 * radius >= options.min_width && 2 * radius <= options.max_width)) return {};
  DepthRock rock{.range = body.near + 0.9 * radius,
                 .bearing = (body.left + body.right) / 2,
                 .radius = radius,
                 .height = body.top,
                 .points = body.points};
  rock.range_sd =
      std::sqrt(0.05 * 0.05 + 0.0625 * radius * radius + std::pow(0.0006 * body.near * body.near, 2));
  rock.bearing_sd = 0.2 * radius / rock.range + 0.5 / focal;
  return rock;
}

}  // namespace

std::vector<DepthRock> find_rocks(const DepthImage& image, const DepthRockOptions& options) {
  const double edge = std::atan(0.5 * double(image.columns - 2) / image.focal);
  std::vector<DepthRock> rocks;
  for (const Body& body : LevelledPoints(image, options).bodies(edge))
    if (const auto rock = rock_of(body, image.focal, options)) rocks.push_back(*rock);
  return rocks;
}

SightingSet sightings_of_rocks(const DepthImage& image, const DepthRockOptions& options) {
  SightingSet set{image.robot_from_sensor, {}};
  for (const DepthRock& rock : find_rocks(image, options)) {
    SeenLandmark s;
    s.type = options.type ? options.type : std::optional<TypeId>(kNoSuchType);
    s.range = rock.range;
    s.range_sd = rock.range_sd;
    s.bearing = rock.bearing;
    s.bearing_sd = rock.bearing_sd;
    if (options.type) {
      s.features.value[0] = rock.radius;
      s.features.variance[0] = std::pow(0.25 * rock.radius + 0.03, 2);
      s.features.value[1] = rock.height;
      s.features.variance[1] = std::pow(0.3 * rock.height + 0.05, 2);
    }
    set.sightings.push_back(s);
  }
  return set;
}

}  // namespace waymark::localization
