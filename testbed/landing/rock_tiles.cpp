// SPDX-License-Identifier: Apache-2.0
#include "testbed/landing/rock_tiles.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::testbed {
namespace {

struct Spot {
  double x = 0, y = 0, scale = 1;  ///< pixels; pixels per metre
};

std::optional<Spot> spot_of(const View& view, const Eigen::Vector3d& point) {
  if (!view.camera)
    return Spot{(point.x() - view.x0) / view.gsd, (view.y0 - point.y()) / view.gsd, 1 / view.gsd};
  const auto pixel = project(*view.camera, Point<GridFrame>{point});
  if (!pixel) return std::nullopt;
  const Eigen::Isometry3d& pose = view.camera->grid_from_camera.transform;
  const double depth = pose.linear().col(2).dot(point - pose.translation());
  // A margin of a fifth covers distortion and the edges of a wide field of view.
  const double range = (point - pose.translation()).norm();
  return Spot{pixel->x(), pixel->y(),
              1.2 * std::max(view.camera->camera.fx, view.camera->camera.fy) * range / (depth * depth)};
}

// Calls visit(column, row) for squares of `side` pixels that the thick line between two spots may touch.
template <class Visit>
void along_line(const Spot& a, const Spot& b, double radius, double side, std::int64_t columns,
                std::int64_t rows, Visit visit) {
  const auto clamped = [&](double at, std::int64_t count) {
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor((at + 0.5) / side)), 0, count - 1);
  };
  const double x0 = std::min(a.x, b.x) - radius, x1 = std::max(a.x, b.x) + radius;
  const double y0 = std::min(a.y, b.y) - radius, y1 = std::max(a.y, b.y) + radius;
  if (x1 < -0.5 || y1 < -0.5 || x0 > double(columns) * side || y0 > double(rows) * side) return;
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const double near = radius + 0.71 * side;
  for (std::int64_t j = clamped(y0, rows); j <= clamped(y1, rows); ++j)
    for (std::int64_t i = clamped(x0, columns); i <= clamped(x1, columns); ++i) {
      const double px = (double(i) + 0.5) * side - 0.5 - a.x, py = (double(j) + 0.5) * side - 0.5 - a.y;
      const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
      if (std::hypot(px - t * dx, py - t * dy) <= near) visit(i, j);
    }
}

}  // namespace

RockTiles bin_rocks(const Scene& scene, const View& view, const Sun& sun, double smallest) {
  constexpr double kSide = RockTiles::kSide;
  const std::int64_t columns = (view.columns + RockTiles::kSide - 1) / RockTiles::kSide;
  const std::int64_t rows = (view.rows + RockTiles::kSide - 1) / RockTiles::kSide;
  RockTiles result{Grid<RockTiles::Tile>(columns, rows), Grid<std::uint8_t>(view.columns, view.rows, 0)};
  const Direction<GridFrame> down_light{-sun_direction(sun).unit};
  const double margin = 200;  // pixels: rocks outside the image whose shadows may fall into it
  for (std::uint32_t k = 0; k < scene.solids.size(); ++k) {
    const RockSolid& rock = scene.solids[k];
    const auto foot = spot_of(view, rock.foot);
    if (!foot || foot->x < -margin || foot->y < -margin || foot->x > double(view.columns) + margin ||
        foot->y > double(view.rows) + margin)
      continue;
    if (2 * std::max(rock.half_x, rock.half_y) * foot->scale < smallest) continue;
    const double radius = rock.reach * foot->scale;
    along_line(*foot, *foot, radius, kSide, columns, rows,
               [&](std::int64_t i, std::int64_t j) { result.tiles(i, j).rocks.push_back(k); });

    // Tip of the shadow: along the light from the top, plus one reach.
    const Point<GridFrame> top{rock.foot + Eigen::Vector3d(0, 0, rock.top)};
    const RayHit hit = scene.terrain.cast({top, down_light});
    const double level = rock.top / std::max(0.02, -down_light.unit.z());
    const double range = std::min(hit.end == RayEnd::ground ? hit.range : 4 * level, 8 * level);
    const auto tip = spot_of(view, top.xyz + (range * 1.1 + rock.reach) * down_light.unit);
    const Spot end = tip ? *tip : *foot;
    const double thick = rock.reach * std::max(foot->scale, end.scale);
    along_line(*foot, end, thick, kSide, columns, rows,
               [&](std::int64_t i, std::int64_t j) { result.tiles(i, j).shadows.push_back(k); });
    along_line(*foot, end, thick + 0.5, 1, view.columns, view.rows,
               [&](std::int64_t i, std::int64_t j) { result.busy(i, j) = 1; });
  }
  return result;
}

}  // namespace waymark::testbed
