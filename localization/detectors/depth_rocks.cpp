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

}  // namespace

std::vector<DepthRock> find_rocks(const DepthImage& image, const DepthRockOptions& options) {
  // Levelled points keep the robot's heading: x ahead, y left of the camera.
  const Eigen::Matrix3d level = (Eigen::AngleAxisd(image.pitch, Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(image.roll, Eigen::Vector3d::UnitX()) *
                                 Eigen::AngleAxisd(image.tilt, Eigen::Vector3d::UnitY()))
                                    .toRotationMatrix();
  const double reach = options.max_range + 2;
  const auto side = static_cast<std::int64_t>(2 * reach / options.cell);
  Grid<Square> squares(side / 2 + 1, side + 1);
  std::vector<Eigen::Vector3d> points;
  const auto column_of = [&](double x) { return static_cast<std::int64_t>(x / options.cell); };
  const auto row_of = [&](double y) { return static_cast<std::int64_t>((y + reach) / options.cell); };
  for (std::int64_t r = 0; r < image.rows; ++r)
    for (std::int64_t c = 0; c < image.columns; ++c) {
      const auto depth = static_cast<double>(image.depths[static_cast<std::size_t>(r * image.columns + c)]);
      if (!(depth > 0) || !std::isfinite(depth)) continue;
      const Eigen::Vector3d p = level * (depth * image.ray(c, r));
      if (!(p.x() > 0 && p.x() < reach && std::abs(p.y()) < reach)) continue;
      Square& square = squares(column_of(p.x()), row_of(p.y()));
      square.lowest = std::min(square.lowest, static_cast<float>(p.z()));
      square.highest = std::max(square.highest, static_cast<float>(p.z()));
      ++square.points;
      points.push_back(p);
    }
  const auto around = static_cast<std::int64_t>(options.around / options.cell);
  Grid<float> ground(squares.columns(), squares.rows(), std::nanf(""));
  for (std::int64_t r = 0; r < squares.rows(); ++r)
    for (std::int64_t c = 0; c < squares.columns(); ++c)
      if (squares(c, r).points > 0) ground(c, r) = static_cast<float>(ground_about(squares, c, r, around));
  const auto stands = [&](std::int64_t c, std::int64_t r) {
    return squares(c, r).points > 0 && double(squares(c, r).highest - ground(c, r)) > options.min_height;
  };

  int segments = 0;
  for (std::int64_t r = 0; r < squares.rows(); ++r)
    for (std::int64_t c = 0; c < squares.columns(); ++c) {
      if (!stands(c, r) || squares(c, r).segment >= 0) continue;
      std::vector<std::pair<std::int64_t, std::int64_t>> open{{c, r}};
      squares(c, r).segment = segments;
      while (!open.empty()) {
        const auto [oc, orow] = open.back();
        open.pop_back();
        for (std::int64_t dr = -1; dr <= 1; ++dr)
          for (std::int64_t dc = -1; dc <= 1; ++dc) {
            const std::int64_t nc = oc + dc, nr = orow + dr;
            if (!squares.contains(nc, nr) || squares(nc, nr).segment >= 0 || !stands(nc, nr)) continue;
            squares(nc, nr).segment = segments;
            open.emplace_back(nc, nr);
          }
      }
      ++segments;
    }

  struct Sum {
    double left = -9, right = 9, near = 1e9, top = -1e9;
    int points = 0;
    bool at_edge = false;
  };
  std::vector<Sum> sums(static_cast<std::size_t>(segments));
  const double edge = std::atan(0.5 * double(image.columns - 2) / image.focal);
  for (const Eigen::Vector3d& p : points) {
    const Square& square = squares(column_of(p.x()), row_of(p.y()));
    const double above = p.z() - double(ground(column_of(p.x()), row_of(p.y())));
    if (square.segment < 0 || !(above > 0.5 * options.min_height)) continue;
    Sum& sum = sums[static_cast<std::size_t>(square.segment)];
    const double bearing = std::atan2(p.y(), p.x());
    sum.left = std::max(sum.left, bearing);
    sum.right = std::min(sum.right, bearing);
    sum.near = std::min(sum.near, p.head<2>().norm());
    sum.top = std::max(sum.top, above);
    ++sum.points;
    sum.at_edge = sum.at_edge || std::abs(bearing) > edge;
  }
  std::vector<DepthRock> rocks;
  for (const Sum& sum : sums) {
    if (sum.points < options.min_points || sum.at_edge || sum.near > options.max_range) continue;
    const double half_sine = std::sin(std::min(sum.left - sum.right, 2.0) / 2);
    const double radius = sum.near * half_sine / (1 - half_sine);
    if (!(2 * radius >= options.min_width && 2 * radius <= options.max_width)) continue;
    DepthRock rock{.range = sum.near + 0.9 * radius,
                   .bearing = (sum.left + sum.right) / 2,
                   .radius = radius,
                   .height = sum.top,
                   .points = sum.points};
    rock.range_sd =
        std::sqrt(0.05 * 0.05 + 0.0625 * radius * radius + std::pow(0.0006 * sum.near * sum.near, 2));
    rock.bearing_sd = 0.2 * radius / rock.range + 0.5 / image.focal;
    rocks.push_back(rock);
  }
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
