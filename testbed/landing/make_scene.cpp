// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "core/error.hpp"
#include "core/random.hpp"
#include "testbed/landing/crater_field.hpp"
#include "testbed/landing/relief.hpp"
#include "testbed/landing/rock_field.hpp"
#include "testbed/scene.hpp"

namespace waymark::testbed {
namespace {

void check(const SiteModel& ground) {
  const auto positive = [](double value, const char* name) {
    if (!(value > 0))
      throw Error(ErrorCode::usage, std::string("ground.") + name + " must be above 0",
                  "it is " + std::to_string(value));
  };
  positive(ground.cell, "cell");
  positive(ground.width, "width");
  positive(ground.height, "height");
  const double nodes = ground.width / ground.cell * ground.height / ground.cell;
  if (!(nodes >= 64 && nodes <= 1e9))
    throw Error(ErrorCode::usage, "the terrain would have " + std::to_string(nodes) + " heights",
                "64 to 1e9 are possible", "change cell, width or height");
  if (ground.craters.density > 0 && !(ground.craters.min_diameter > 0 && ground.craters.slope > 0 &&
                                      ground.craters.max_diameter > ground.craters.min_diameter))
    throw Error(ErrorCode::usage, "craters need 0 < min_diameter < max_diameter and slope > 0");
  if (ground.rocks.k > 0 && !(ground.rocks.min_diameter > 0 && ground.rocks.ellipsoids >= 0 &&
                              ground.rocks.irregular >= 0 && ground.rocks.cylinders >= 0 &&
                              ground.rocks.ellipsoids + ground.rocks.irregular + ground.rocks.cylinders > 0))
    throw Error(ErrorCode::usage, "rocks need min_diameter > 0 and fractions of shapes that are not all 0");
}

}  // namespace

Scene make_scene(const SiteModel& ground, std::uint64_t seed) {
  check(ground);
  const NodeGrid nodes = nodes_of(ground);
  // Craters level the terrain that they hit, so the finest relief is added after them.
  const double finest = std::min(ground.relief.longest, 10 * ground.cell);
  Grid<float> heights = coarse_relief(ground, nodes, finest, seed);
  const std::vector<CraterPlan> plans = draw_craters(ground, seed);
  for (const CraterPlan& plan : plans) excavate(heights, nodes, plan);
  const Grid<float> outcrops = add_outcrops(heights, ground, nodes, seed);
  const Grid<float> dunes = add_dunes(heights, ground, nodes, seed);

  Fractal all = relief_fractal(ground.relief, 2 * ground.cell, seed);
  while (all.longest > finest) all.longest /= 2, all.amplitude *= std::exp2(-all.hurst);
  all.seed = static_cast<std::uint32_t>(named_seed(seed, "fine relief"));
  all.amplitude *= ground.relief.roughness;
  const Grid<float> fine = fractal_grid(all, nodes);
  for (std::size_t i = 0; i < heights.cells().size(); ++i) heights.cells()[i] += fine.cells()[i];

  Scene scene{.ground = ground,
              .seed = seed,
              .terrain = Terrain(std::move(heights), nodes.x0, nodes.y0, nodes.step, nodes.step),
              .albedo = paint_albedo(ground, nodes, dunes, outcrops, plans, seed),
              .solids = {},
              .rocks = {},
              .craters = {}};
  for (const CraterPlan& plan : plans)
    if (const auto crater = measure_crater(scene.terrain, plan)) scene.craters.push_back(*crater);
  std::stable_sort(scene.craters.begin(), scene.craters.end(),
                   [](const auto& a, const auto& b) { return a.diameter() > b.diameter(); });
  RockField field = scatter_rocks(ground, scene.terrain, dunes, plans, seed);
  scene.solids = std::move(field.solids);
  scene.rocks = std::move(field.rocks);
  return scene;
}

}  // namespace waymark::testbed
