// SPDX-License-Identifier: Apache-2.0
#include "tests/pipeline/craters/placed_craters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "pipeline/craters/crater_candidate.hpp"
#include "testbed/landing/crater_field.hpp"
#include "testbed/landing/crater_profile.hpp"
#include "testbed/landing/relief.hpp"
#include "testbed/render.hpp"

namespace waymark::test {
namespace {

constexpr int kSquares = 6;      // per side
constexpr double kSquare = 128;  // metres, and pixels
constexpr double kWidth = kSquares * kSquare;

struct PlacedPlan {
  testbed::CraterPlan plan;
  Place place;
};

testbed::CraterPlan draw_plan(Random& random, double east, double north, double diameter, double min_depth) {
  const double ratio = random.uniform(0.9, 1);
  return {.east = east,
          .north = north,
          .major = diameter / std::sqrt(ratio),
          .minor = diameter * std::sqrt(ratio),
          .turn = random.uniform(-1.5, 1.5),
          .age = testbed::CraterProfiles::instance().age(random.uniform(min_depth, 0.2)),
          .infill = 0,
          .seed = static_cast<std::uint32_t>(random.bits())};
}

// Appends the craters of one square, older ones first.
void draw_square(Random& random, double east, double north, std::vector<PlacedPlan>& plans) {
  const auto place = static_cast<Place>(random.uniform_index(kPlaces.size()));
  const double turn = random.uniform(0, 2 * std::numbers::pi);
  const auto add = [&](double away, double diameter, double min_depth) -> testbed::CraterPlan& {
    plans.push_back(
        {draw_plan(random, east + away * std::cos(turn), north + away * std::sin(turn), diameter, min_depth),
         place});
    return plans.back().plan;
  };
  const auto pair = [&](double large, double ratio, double distance) {
    add(-0.5 * distance, large, 0.1);
    add(0.5 * distance, large * ratio, 0.1);
  };
  if (place == Place::isolated) {
    add(0, random.log_uniform(17, 56), 0.1);
  } else if (place == Place::doublet) {
    const double large = random.log_uniform(22, 52);
    pair(large, random.uniform(0.85, 1), large * random.uniform(0.45, 0.9));
  } else if (place == Place::overlapping) {
    const double large = random.log_uniform(32, 56), ratio = random.uniform(0.55, 0.8);
    pair(large, ratio, large / 2 * random.uniform(1 - 0.3 * ratio, 1 + 0.5 * ratio));
  } else if (place == Place::on_rim) {
    const double large = random.uniform(44, 60);
    pair(large, random.uniform(0.38, 0.5), large / 2);
  } else if (place == Place::nested) {
    const double large = random.uniform(40, 60), ratio = random.uniform(0.42, 0.7);
    pair(large, ratio, large / 2 * (1 - ratio) * random.uniform(0.2, 1));
  } else {
    testbed::CraterPlan& plan = add(0, random.log_uniform(17, 56), 0.15);
    plan.infill = place == Place::flooded ? random.uniform(0.5, 0.9) : random.uniform(0.9, 1);
  }
}

testbed::SiteModel draw_site(Random& random) {
  testbed::SiteModel site;
  site.width = site.height = 1.1 * kWidth;
  site.cell = 1;
  site.relief.longest = random.uniform(150, 400);
  site.relief.rms = site.relief.longest * random.log_uniform(0.002, 0.01);
  site.relief.hurst = random.uniform(0.75, 0.95);
  site.relief.roughness = random.log_uniform(0.3, 1);
  site.craters.density = 0;
  site.rocks.k = 0;
  site.dunes.cover = random.bernoulli(0.3) ? random.uniform(0, 0.2) : 0;
  site.albedo.variation = random.log_uniform(0.02, 0.15);
  return site;
}

PlacedScene render(testbed::Scene ground, const std::vector<PlacedPlan>& plans, Random& random,
                   std::uint64_t seed) {
  testbed::Exposure exposure;
  exposure.sun = {Degrees{random.uniform(0, 360)}, Degrees{random.uniform(15, 50)}, Degrees{0.5}};
  exposure.psf_sd = random.uniform(0.5, 1);
  exposure.read_noise = random.log_uniform(0.002, 0.01);
  exposure.contrast = random.log_uniform(0.8, 2);
  exposure.samples = 1;
  const auto side = static_cast<std::int64_t>(kWidth);
  const testbed::View view = testbed::map_view(ground, 1, side, side);
  PlacedScene scene;
  scene.image = testbed::render_view(ground, view, exposure, seed);
  for (float& value : scene.image.cells()) value = std::round(255 * std::clamp(value, 0.0F, 1.0F));
  scene.sun_angle = {testbed::image_sun_angle(view, exposure.sun)};
  for (const PlacedPlan& p : plans) {
    const auto crater = testbed::measure_crater(ground.terrain, p.plan);
    if (p.plan.diameter() < 16 || !crater) continue;
    if (p.plan.infill == 0 && crater->preserved_fraction() < testbed::kErased) continue;
    scene.craters.push_back({p.plan.east - view.x0, view.y0 - p.plan.north, p.plan.diameter(), p.place});
  }
  return scene;
}

}  // namespace

PlacedScene placed_scene(std::uint64_t seed) {
  Random random(seed, "placed craters");
  const testbed::SiteModel site = draw_site(random);
  testbed::Scene ground = testbed::make_scene(site, seed);
  const testbed::NodeGrid nodes = testbed::nodes_of(site);
  std::vector<PlacedPlan> plans;
  for (int row = 0; row < kSquares; ++row)
    for (int column = 0; column < kSquares; ++column)
      draw_square(random, (column + 0.5) * kSquare - kWidth / 2 + random.uniform(-10, 10),
                  (row + 0.5) * kSquare - kWidth / 2 + random.uniform(-10, 10), plans);
  Grid<float> heights = ground.terrain.heights();
  for (const PlacedPlan& p : plans) testbed::excavate(heights, nodes, p.plan);
  ground.terrain = Terrain(std::move(heights), nodes.x0, nodes.y0, nodes.step, nodes.step);

  return render(std::move(ground), plans, random, seed);
}

PlacedScene field_scene(std::uint64_t seed) {
  Random random(seed, "field of craters");
  testbed::SiteModel site = draw_site(random);
  site.craters.density = random.log_uniform(0.2, 1.5);
  site.craters.min_diameter = 5;
  site.craters.max_diameter = 150;
  site.craters.slope = random.uniform(1.9, 2.2);
  site.craters.density *= std::pow(20, site.craters.slope - 2);
  site.craters.oldest_depth = 0.05;
  const testbed::Scene ground = testbed::make_scene(site, seed);
  std::vector<PlacedPlan> plans;
  for (const testbed::CraterPlan& plan : testbed::draw_craters(site, seed))
    plans.push_back({plan, Place::isolated});
  PlacedScene scene = render(ground, plans, random, seed);
  for (PlacedCrater& c : scene.craters)
    for (const PlacedCrater& other : scene.craters)
      if (&other != &c && overlap({c.x, c.y, c.diameter, 0}, {other.x, other.y, other.diameter, 0}) > 0.02)
        c.place = Place::overlapping;
  return scene;
}

}  // namespace waymark::test
