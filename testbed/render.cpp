// SPDX-License-Identifier: Apache-2.0
#include "testbed/render.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.hpp"
#include "core/grid.hpp"
#include "core/random.hpp"
#include "testbed/landing/lit_terrain.hpp"
#include "testbed/noise.hpp"
#include "testbed/sensor.hpp"

namespace waymark::testbed {
namespace {

constexpr double kDustAlbedo = 0.3;    // of clouds of fine Martian dust, seen from above
constexpr double kShieldAlbedo = 0.5;  // of insulation
constexpr double kMinRock = 0.6;       // pixels; smaller rocks change no pixel by more than the noise

// Rocks and rock shadows that may be visible in each square of an image.
struct RockTiles {
  static constexpr std::int64_t kSide = 16;  // pixels

  struct Tile {
    std::vector<std::uint32_t> rocks, shadows;  // indices into Scene::solids
  };
  Grid<Tile> tiles;
  Grid<std::uint8_t> busy;  // per pixel: near a rock or its shadow, so it is supersampled
};

struct Spot {
  double x = 0, y = 0, scale = 1;  // pixels; pixels per metre
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

// Discards rocks whose outline is narrower than `smallest` pixels.
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

// Pixels that the shield may cover are supersampled, as those near rocks are.
void mark_shield(const View& view, Grid<std::uint8_t>& busy) {
  if (!(view.shield.radius > 0)) return;
  const auto spot = spot_of(view, view.shield.centre);
  if (!spot) return;
  const double radius = view.shield.radius * spot->scale + 1;
  along_line(*spot, *spot, radius, 1, view.columns, view.rows,
             [&](std::int64_t i, std::int64_t j) { busy(i, j) = 1; });
}

struct Painter {
  const Scene& scene;
  const LitTerrain& ground;
  const View& view;
  const Exposure& exposure;
  const RockTiles& rocks;
  Eigen::Vector3d light;
  double pixel_angle;  ///< radians per pixel of a camera
  int instants;        ///< of an exposure while the camera moves; 0: it does not

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

  // Light of the shield, if the ray meets it before the ground.
  std::optional<double> shield_light(const Ray<GridFrame>& line, const RayHit& hit) const {
    const FallingShield& shield = view.shield;
    if (!(shield.radius > 0)) return std::nullopt;
    const double across = shield.normal.dot(line.direction.unit);
    if (!(std::abs(across) > 1e-9)) return std::nullopt;
    const double range = shield.normal.dot(shield.centre - line.origin.xyz) / across;
    const double ground_range =
        hit.end == RayEnd::ground ? hit.range : std::numeric_limits<double>::infinity();
    const Eigen::Vector3d at = line.origin.xyz + range * line.direction.unit;
    if (!(range > 0 && range < ground_range && (at - shield.centre).norm() <= shield.radius))
      return std::nullopt;
    const Eigen::Vector3d facing = across < 0 ? shield.normal : Eigen::Vector3d(-shield.normal);
    return brightness(kShieldAlbedo, 1, facing, -line.direction.unit);
  }

  // Whether the shield stands between a point of the ground and the sun.
  bool behind_shield(const Eigen::Vector3d& point) const {
    const FallingShield& shield = view.shield;
    const double across = shield.normal.dot(light);
    if (!(shield.radius > 0) || !(std::abs(across) > 1e-9)) return false;
    const double range = shield.normal.dot(shield.centre - point) / across;
    return range > 0 && (point + range * light - shield.centre).norm() <= shield.radius;
  }

  // Light of the ground through the dust, along a ray that falls by `fall` per metre.
  double through_dust(double from_ground, const Eigen::Vector3d& point, double fall) const {
    if (!(view.dust.depth > 0)) return from_ground;
    const double depth = dust_depth(view.dust, point.x(), point.y());
    if (!(depth > 0)) return from_ground;
    const double seen = std::exp(-depth / std::max(0.1, fall));
    const double cloud = brightness(kDustAlbedo, 1, {0, 0, 1}, {0, 0, 1});
    return seen * from_ground + (1 - seen) * cloud;
  }

  // Light along the ray of a pixel; NaN beyond the terrain.
  double sample(double x, double y, const RockTiles::Tile& tile) const {
    const auto line = ray_through(x, y);
    if (!line) return std::numeric_limits<double>::quiet_NaN();
    const RayHit hit = scene.terrain.cast(*line);
    if (const auto light_of_shield = shield_light(*line, hit)) return *light_of_shield;
    if (hit.end != RayEnd::ground) return std::numeric_limits<double>::quiet_NaN();
    return sample(*line, hit, tile);
  }

  // The same, seconds after the middle of the exposure. Rocks are those of the pixel that shows the ground
  // there at the middle of the exposure.
  double sample_at(double seconds, double x, double y) const {
    auto line = ray_through(x, y);
    if (!line) return std::numeric_limits<double>::quiet_NaN();
    line->origin.xyz += seconds * view.motion.velocity;
    const double angle = seconds * view.motion.spin.norm();
    if (angle != 0)
      line->direction.unit = Eigen::AngleAxisd(angle, view.motion.spin.normalized()) * line->direction.unit;
    const RayHit hit = scene.terrain.cast(*line);
    if (const auto light_of_shield = shield_light(*line, hit)) return *light_of_shield;
    if (hit.end != RayEnd::ground) return std::numeric_limits<double>::quiet_NaN();
    const auto spot = spot_of(view, hit.point.xyz);
    const auto tile_of = [](double at, std::int64_t tiles) {
      const double tile = std::floor((at + 0.5) / double(RockTiles::kSide));
      return static_cast<std::int64_t>(std::clamp(tile, 0.0, double(tiles - 1)));
    };
    const Spot at = spot.value_or(Spot{x, y, 1});
    return sample(*line, hit,
                  rocks.tiles(tile_of(at.x, rocks.tiles.columns()), tile_of(at.y, rocks.tiles.rows())));
  }

  double sample(const Ray<GridFrame>& line, const RayHit& hit, const RockTiles::Tile& tile) const {
    return through_dust(ground_light(line, hit, tile), hit.point.xyz, -line.direction.unit.z());
  }

  double ground_light(const Ray<GridFrame>& line, const RayHit& hit, const RockTiles::Tile& tile) const {
    constexpr auto kNone = static_cast<std::uint32_t>(-1);
    const Eigen::Vector3d& along = line.direction.unit;
    const double size = view.camera ? hit.range * pixel_angle : view.gsd;

    std::uint32_t rock = kNone;
    SolidHit nearest{hit.range, {}};
    for (const std::uint32_t k : tile.rocks)
      if (const auto met = intersect(scene.solids[k], line.origin.xyz, along); met && met->t < nearest.t)
        nearest = *met, rock = k;
    if (rock == kNone) {
      const SurfaceShading look = ground.shading(hit.point.xyz, size);
      const bool hidden =
          look.lit > 0 && (behind_rock(tile, hit.point.xyz, kNone) || behind_shield(hit.point.xyz));
      const double lit = hidden ? 0 : look.lit;
      return brightness(look.albedo, lit, Eigen::Vector3d(-look.slope_x, -look.slope_y, 1).normalized(),
                        -along);
    }
    const Eigen::Vector3d point = line.origin.xyz + nearest.t * along;
    const SurfaceShading look = ground.shading(scene.solids[rock].foot, size);
    const bool free =
        point.z() > ground.shadow_height(point.x(), point.y()) && !behind_rock(tile, point, rock);
    return brightness(look.albedo * scene.solids[rock].brightness, free ? 1 : 0, nearest.normal, -along);
  }

  double pixel(std::int64_t i, std::int64_t j) const {
    if (instants > 0) return moving_pixel(i, j);
    const auto& tile = rocks.tiles(i / RockTiles::kSide, j / RockTiles::kSide);
    const int n = rocks.busy(i, j) ? std::max(1, exposure.samples) : 1;
    double sum = 0;
    for (int b = 0; b < n; ++b)
      for (int a = 0; a < n; ++a)
        sum += sample(double(i) + (a + 0.5) / n - 0.5, double(j) + (b + 0.5) / n - 0.5, tile);
    return sum / (n * n);
  }

  // Mean over the exposure of the row; the instants share the rays of a pixel near rocks.
  double moving_pixel(std::int64_t i, std::int64_t j) const {
    const int n = rocks.busy(i, j) ? std::max(1, exposure.samples) : 1, count = std::max(instants, n * n);
    const double row = view.rows > 1 ? double(j) / double(view.rows - 1) - 0.5 : 0;
    double sum = 0;
    for (int k = 0; k < count; ++k) {
      const double t = exposure.readout_time * row + exposure.exposure_time * ((k + 0.5) / count - 0.5);
      const int ray = n == 1 ? 0 : k * 7 % (n * n);  // spreads neighbouring instants over the pixel
      sum += sample_at(t, double(i) + (ray % n + 0.5) / n - 0.5, double(j) + (ray / n % n + 0.5) / n - 0.5);
    }
    return sum / count;
  }
};

/// Returns the number of instants at which an exposure samples its motion: one for each half pixel of blur, 0
/// for a camera that stands still.
int instants_of(const Scene& scene, const View& view, const Exposure& exposure, double focal) {
  constexpr double kMaxInstants = 32;
  const bool moves = view.motion.velocity.norm() + view.motion.spin.norm() > 0;
  if (!view.camera || !moves || !(exposure.exposure_time + exposure.readout_time > 0)) return 0;
  const double height =
      view.camera->grid_from_camera.transform.translation().z() - scene.terrain.max_height();
  const double blur = exposure.exposure_time * focal *
                      (view.motion.spin.norm() + view.motion.velocity.norm() / std::max(1.0, height));
  return static_cast<int>(std::clamp(std::ceil(2 * blur), 1.0, kMaxInstants));
}

}  // namespace

double dust_depth(const DustCloud& dust, double x, double y) {
  if (!(dust.depth > 0 && dust.radius > 0)) return 0;
  const double east = x - dust.centre.x(), north = y - dust.centre.y(), range = std::hypot(east, north);
  // Billows run outwards, and grow with the distance.
  const Fractal billows{.longest = dust.radius / 3,
                        .shortest = dust.radius / 30,
                        .amplitude = 0.5,
                        .hurst = 0.5,
                        .seed = static_cast<std::uint32_t>(mix_bits(dust.seed))};
  const double shape = std::exp(-range / dust.radius) * std::max(0.0, 1 + billows.at(east, north).value);
  return dust.depth * std::min(shape, 1.0);
}

Pixels render_view(const Scene& scene, const LitTerrain& ground, const View& view, const Exposure& exposure,
                   std::uint64_t noise_seed) {
  if (view.columns < 1 || view.rows < 1) throw Error(ErrorCode::usage, "an image needs at least one pixel");
  if (!(exposure.sun.elevation.value > 0))
    throw Error(ErrorCode::usage, "the sun is below the horizon: nothing to see",
                "elevation " + std::to_string(exposure.sun.elevation.value) + " degrees");
  RockTiles rocks = bin_rocks(scene, view, ground.sun(), kMinRock);
  mark_shield(view, rocks.busy);
  const double focal = view.camera ? std::max(view.camera->camera.fx, view.camera->camera.fy) : 1;
  const Painter painter{scene,     ground,
                        view,      exposure,
                        rocks,     sun_direction(ground.sun()).unit,
                        1 / focal, instants_of(scene, view, exposure, focal)};
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
