// SPDX-License-Identifier: Apache-2.0
#include "testbed/render.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/random.hpp"
#include "testbed/landing/lit_terrain.hpp"
#include "testbed/landing/rock_tiles.hpp"
#include "testbed/sensor.hpp"

namespace waymark::testbed {
namespace {

constexpr double kMinRock = 0.6;  // pixels; smaller rocks change no pixel by more than the noise

struct Painter {
  const Scene& scene;
  const LitTerrain& ground;
  const View& view;
  const Exposure& exposure;
  const RockTiles& rocks;
  Eigen::Vector3d light;
  double pixel_angle;  ///< radians per pixel of a camera

  double brightness(double albedo, double lit, const Eigen::Vector3d& normal,
                    const Eigen::Vector3d& to_eye) const {
    const double sun = normal.dot(light), eye = std::max(0.05, normal.dot(to_eye));
    double direct = 0;
    if (sun > 0 && lit > 0) {
      const double seeliger = 2 * sun / (sun + eye);
      direct = exposure.photometry == Photometry::lambert           ? sun
               : exposure.photometry == Photometry::lommel_seeliger ? seeliger
                                                                    : (sun + seeliger) / 2;
    }
    return albedo * (lit * direct + exposure.skylight * (0.5 + 0.5 * normal.z()));
  }

  bool behind_rock(const RockTiles::Tile& tile, const Eigen::Vector3d& point, std::uint32_t self) const {
    return std::any_of(tile.shadows.begin(), tile.shadows.end(), [&](std::uint32_t k) {
      return k != self && intersects(scene.solids[k], point, light);
    });
  }

  std::optional<Ray<GridFrame>> ray_through(double x, double y) const {
    if (view.camera) return ray(*view.camera, Eigen::Vector2d(x, y));
    return Ray<GridFrame>{
        {{view.x0 + x * view.gsd, view.y0 - y * view.gsd, scene.terrain.max_height() + 100}}, {{0, 0, -1}}};
  }

  // Light along one ray; NaN beyond the terrain.
  double sample(double x, double y, const RockTiles::Tile& tile) const {
    constexpr auto kNone = static_cast<std::uint32_t>(-1);
    const auto line = ray_through(x, y);
    if (!line) return std::numeric_limits<double>::quiet_NaN();
    const RayHit hit = scene.terrain.cast(*line);
    if (hit.end != RayEnd::ground) return std::numeric_limits<double>::quiet_NaN();
    const Eigen::Vector3d& along = line->direction.unit;
    const double size = view.camera ? hit.range * pixel_angle : view.gsd;

    std::uint32_t rock = kNone;
    SolidHit nearest{hit.range, {}};
    for (const std::uint32_t k : tile.rocks)
      if (const auto met = intersect(scene.solids[k], line->origin.xyz, along); met && met->t < nearest.t)
        nearest = *met, rock = k;
    if (rock == kNone) {
      const SurfaceShading look = ground.shading(hit.point.xyz, size);
      const double lit = look.lit > 0 && behind_rock(tile, hit.point.xyz, kNone) ? 0 : look.lit;
      return brightness(look.albedo, lit, Eigen::Vector3d(-look.slope_x, -look.slope_y, 1).normalized(),
                        -along);
    }
    const Eigen::Vector3d point = line->origin.xyz + nearest.t * along;
    const SurfaceShading look = ground.shading(scene.solids[rock].foot, size);
    const bool free =
        point.z() > ground.shadow_height(point.x(), point.y()) && !behind_rock(tile, point, rock);
    return brightness(look.albedo * scene.solids[rock].brightness, free ? 1 : 0, nearest.normal, -along);
  }

  double pixel(std::int64_t i, std::int64_t j) const {
    const auto& tile = rocks.tiles(i / RockTiles::kSide, j / RockTiles::kSide);
    const int n = rocks.busy(i, j) ? std::max(1, exposure.samples) : 1;
    double sum = 0;
    for (int b = 0; b < n; ++b)
      for (int a = 0; a < n; ++a)
        sum += sample(double(i) + (a + 0.5) / n - 0.5, double(j) + (b + 0.5) / n - 0.5, tile);
    return sum / (n * n);
  }
};

}  // namespace

Pixels render_view(const Scene& scene, const LitTerrain& ground, const View& view, const Exposure& exposure,
                   std::uint64_t noise_seed) {
  if (view.columns < 1 || view.rows < 1) throw Error(ErrorCode::usage, "an image needs at least one pixel");
  if (!(exposure.sun.elevation.value > 0))
    throw Error(ErrorCode::usage, "the sun is below the horizon: nothing to see",
                "elevation " + std::to_string(exposure.sun.elevation.value) + " degrees");
  const RockTiles rocks = bin_rocks(scene, view, ground.sun(), kMinRock);
  const double focal = view.camera ? std::max(view.camera->camera.fx, view.camera->camera.fy) : 1;
  const Painter painter{scene, ground, view, exposure, rocks, sun_direction(ground.sun()).unit, 1 / focal};
  Pixels light(view.columns, view.rows);
  tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, view.rows, 8), [&](const auto& range) {
    for (std::int64_t j = range.begin(); j < range.end(); ++j)
      for (std::int64_t i = 0; i < view.columns; ++i) light(i, j) = static_cast<float>(painter.pixel(i, j));
  });
  const double sunlit = painter.brightness(scene.ground.albedo.mean, 1, {0, 0, 1}, {0, 0, 1});
  return apply_sensor(light, exposure, sunlit, noise_seed);
}

Pixels render_view(const Scene& scene, const View& view, const Exposure& exposure, std::uint64_t noise_seed) {
  return render_view(scene, LitTerrain(scene, exposure.sun), view, exposure, noise_seed);
}

}  // namespace waymark::testbed
