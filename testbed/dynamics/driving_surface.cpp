// SPDX-License-Identifier: Apache-2.0
#include "testbed/dynamics/driving_surface.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::testbed {
namespace {

constexpr double kSquare = 4;           // m
constexpr double kMaxRadius = 1.5;      // m, of a wheel, and half its width
constexpr int kAlong = 5, kAcross = 1;  // samples of the rim on each side of the centre
constexpr double kRimAngle = 1.4;       // rad, from the lowest point of the rim to the farthest sample

std::int64_t square_of(double offset) {
  return static_cast<std::int64_t>(std::floor(offset / kSquare));
}

}  // namespace

DrivingSurface::DrivingSurface(const Terrain& terrain, std::span<const RockSolid> rocks)
    : terrain_(terrain), rocks_(rocks) {
  const Grid<float>& heights = terrain.heights();
  const double width = static_cast<double>(heights.columns() - 1) * terrain.step_x();
  const double height = static_cast<double>(heights.rows() - 1) * terrain.step_y();
  squares_ = Grid<std::vector<std::uint32_t>>(square_of(width) + 1, square_of(height) + 1);
  for (std::uint32_t rock = 0; rock < rocks.size(); ++rock) {
    const double reach = rocks[rock].reach + kMaxRadius;
    const double x = rocks[rock].foot.x() - terrain.x0(), y = terrain.y0() - rocks[rock].foot.y();
    const std::int64_t last_column = std::min(squares_.columns() - 1, square_of(x + reach));
    const std::int64_t last_row = std::min(squares_.rows() - 1, square_of(y + reach));
    for (std::int64_t row = std::max<std::int64_t>(0, square_of(y - reach)); row <= last_row; ++row)
      for (std::int64_t column = std::max<std::int64_t>(0, square_of(x - reach)); column <= last_column;
           ++column)
        squares_(column, row).push_back(rock);
  }
}

const std::vector<std::uint32_t>* DrivingSurface::rocks_near(const Eigen::Vector2d& position) const {
  const std::int64_t column = square_of(position.x() - terrain_.x0()),
                     row = square_of(terrain_.y0() - position.y());
  return squares_.contains(column, row) ? &squares_(column, row) : nullptr;
}

std::optional<DrivingSurface::Point> DrivingSurface::at(const Eigen::Vector2d& position) const {
  const auto ground = terrain_.height(position.x(), position.y());
  if (!ground) return {};
  Point point{.height = *ground};
  if (const auto* near = rocks_near(position))
    for (const std::uint32_t index : *near) {
      const RockSolid& rock = rocks_[index];
      if ((position - rock.foot.head<2>()).squaredNorm() > rock.reach * rock.reach) continue;
      const double above = rock.foot.z() + rock.reach + 1;
      const auto hit = intersect(rock, {position.x(), position.y(), above}, -Eigen::Vector3d::UnitZ());
      if (hit && above - hit->t > point.height)
        point = {.height = above - hit->t, .normal = hit->normal, .on_rock = true};
    }
  if (!point.on_rock) point.normal = *terrain_.normal(position.x(), position.y());
  return point;
}

std::optional<DrivingSurface::Touch> DrivingSurface::lower_wheel(const Eigen::Vector2d& centre,
                                                                 const Eigen::Vector2d& heading,
                                                                 double radius, double width) const {
  const auto ground = terrain_.height(centre.x(), centre.y());
  if (!ground) return {};
  const Eigen::Vector3d slope = *terrain_.normal(centre.x(), centre.y());
  // On a slope the rim touches before its lowest point.
  Touch touch{.height = *ground + radius * (1 / slope.z() - 1), .normal = slope};
  const auto* near = rocks_near(centre);
  if (near == nullptr) return touch;
  const Eigen::Vector2d across(-heading.y(), heading.x());
  for (const std::uint32_t index : *near) {
    const RockSolid& rock = rocks_[index];
    const double reach = rock.reach + std::hypot(radius, width / 2);
    if ((centre - rock.foot.head<2>()).squaredNorm() > reach * reach) continue;
    const double above = rock.foot.z() + rock.reach + 1;
    for (int i = -kAlong; i <= kAlong; ++i)
      for (int k = -kAcross; k <= kAcross; ++k) {
        const double along = radius * std::sin(kRimAngle * i / kAlong),
                     sideways = 0.9 * width / 2 * k / kAcross;
        const Eigen::Vector2d at = centre + along * heading + sideways * across;
        const auto hit = intersect(rock, {at.x(), at.y(), above}, -Eigen::Vector3d::UnitZ());
        if (!hit) continue;
        const double down = std::sqrt(radius * radius - along * along);
        const double height = above - hit->t + down - radius;
        if (height <= touch.height) continue;
        Eigen::Vector3d normal;
        normal << -along / radius * heading, down / radius;
        touch = {.height = height, .normal = normal, .on_rock = true};
      }
  }
  return touch;
}

}  // namespace waymark::testbed
