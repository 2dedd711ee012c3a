// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/crater_training_data.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "pipeline/craters/crater_features.hpp"
#include "testbed/render.hpp"

namespace waymark::workflows {
namespace {

testbed::SiteModel draw_ground(Random& random, double gsd, double width) {
  testbed::SiteModel ground;
  ground.width = ground.height = 1.15 * width;
  ground.cell = random.uniform(1, 1.6) * gsd;
  ground.relief.longest = width * random.log_uniform(0.2, 1.5);
  ground.relief.rms = ground.relief.longest * random.log_uniform(0.002, 0.025);
  ground.relief.hurst = random.uniform(0.6, 0.95);
  ground.relief.roughness = random.log_uniform(0.3, 1.5);
  ground.relief.slope = std::tan(random.uniform(0, 0.12));
  ground.relief.slope_azimuth = {random.uniform(0, 360)};
  if (random.bernoulli(0.3)) {
    ground.relief.mountains = 1 + static_cast<int>(random.uniform_index(4));
    ground.relief.mountain_radius = width * random.uniform(0.05, 0.3);
    ground.relief.mountain_height = ground.relief.mountain_radius * random.uniform(0.05, 0.4);
  }
  ground.craters.slope = random.uniform(1.8, 2.5);
  // As many 12 pixel craters per pixel at any scale.
  ground.craters.density = random.log_uniform(0.1, 1.2) * std::pow(12 * gsd, ground.craters.slope - 2);
  ground.craters.min_diameter = 4 * gsd;
  ground.craters.max_diameter = 0.4 * width;
  ground.craters.fresh = random.uniform(0.05, 0.4);
  ground.craters.oldest_depth = random.uniform(0.02, 0.05);
  ground.craters.infill = random.uniform(0.1, 0.5);
  ground.craters.clusters = static_cast<int>(random.uniform_index(4));
  ground.rocks.k = random.log_uniform(0.005, 0.2);
  ground.rocks.min_diameter = std::max(0.4, 1.5 * gsd);
  ground.rocks.max_diameter = std::max(1.0, random.uniform(3, 12) * gsd);
  ground.dunes.cover = random.bernoulli(0.5) ? random.uniform(0, 0.4) : 0;
  ground.dunes.wavelength = random.log_uniform(5, 40) * gsd;
  ground.dunes.height = ground.dunes.wavelength * random.uniform(0.02, 0.08);
  if (random.bernoulli(0.2)) ground.outcrops.cover = random.uniform(0, 0.1);
  ground.outcrops.height = 3 * gsd;
  ground.outcrops.longest = 0.1 * width;
  ground.albedo.variation = random.log_uniform(0.02, 0.25);
  ground.albedo.longest = width * random.uniform(0.1, 0.6);
  ground.albedo.rays = random.uniform(0, 0.4);
  return ground;
}

testbed::Exposure draw_exposure(Random& random) {
  testbed::Exposure exposure;
  exposure.sun = {Degrees{random.uniform(0, 360)}, Degrees{random.uniform(12, 60)}, Degrees{0.5}};
  const auto kind = random.uniform_index(3);
  exposure.photometry = kind == 0   ? testbed::Photometry::lambert
                        : kind == 1 ? testbed::Photometry::lommel_seeliger
                                    : testbed::Photometry::lunar_lambert;
  exposure.skylight = random.uniform(0.01, 0.25);
  exposure.haze = random.uniform(0, 0.2);
  exposure.psf_sd = random.uniform(0.4, 1.1);
  exposure.read_noise = random.log_uniform(0.001, 0.015);
  exposure.contrast = random.log_uniform(0.7, 2.5);
  exposure.samples = 2;
  return exposure;
}

}  // namespace

pipeline::LabelledScene make_testbed_scene(std::uint64_t seed, int side) {
  Random random(seed, "testbed lesson on craters");
  const double gsd = random.log_uniform(0.2, 5);
  const testbed::Scene scene = testbed::make_scene(draw_ground(random, gsd, gsd * side), seed);
  const testbed::Exposure exposure = draw_exposure(random);
  const testbed::View view = testbed::map_view(scene, gsd, side, side);
  pipeline::LabelledScene known_scene;
  known_scene.image = testbed::render_view(scene, view, exposure, seed);
  for (float& value : known_scene.image.cells()) value = std::round(255 * std::clamp(value, 0.0F, 1.0F));
  known_scene.sun_angle = {testbed::image_sun_angle(view, exposure.sun)};
  const pipeline::PatchSource patches(known_scene.image, known_scene.sun_angle);
  for (const testbed::TrueCrater& crater : scene.craters) {
    const auto outline = testbed::image_outline(view, crater);
    pipeline::LabelledCrater known{(crater.position.x() - view.x0) / gsd,
                                   (view.y0 - crater.position.y()) / gsd, crater.diameter() / gsd, 0};
    if (known.diameter < 5) continue;
    if (outline && crater.preserved_fraction() >= testbed::kErased)
      known.clarity = std::clamp(patches.slope_correlation({known.x, known.y, known.diameter, 0}), 0.0, 1.0);
    known_scene.craters.push_back(known);
  }
  return known_scene;
}

}  // namespace waymark::workflows
