// SPDX-License-Identifier: Apache-2.0
#include "tests/pipeline/rocks/boulder_scene.hpp"

#include <cmath>

#include "core/random.hpp"
#include "testbed/render.hpp"
namespace waymark::test {
namespace {

constexpr std::int64_t kPixels = 640;

// Returns the k of Golombek's law at which about `count` rocks wider than `width` lie in the picture.
double abundance_for(double count, double width, double side) {
  double k = 0.01;
  while (k < 5 && k * std::exp(-(1.79 + 0.152 / k) * width) * side * side < count * 1.2 * width * width)
    k *= 1.05;
  return k;
}

testbed::SiteModel site(double gsd, Random& random) {
  testbed::SiteModel site;
  site.width = site.height = 1.5 * gsd * kPixels;
  site.cell = 4 * gsd;
  site.relief.roughness = random.log_uniform(0.3, 1);
  site.relief.rms = random.uniform(0.2, 0.8);
  site.relief.longest = 60;
  site.relief.slope = std::tan(random.uniform(0, 0.12));
  site.relief.slope_azimuth = {random.uniform(0, 360)};
  site.dunes.cover = random.uniform(0, 0.1);
  site.dunes.wavelength = 40 * gsd;
  site.dunes.height = 2 * gsd;
  site.craters.density = random.uniform(0, 0.5);
  site.craters.min_diameter = 30 * gsd;
  site.craters.max_diameter = 250 * gsd;
  site.rocks.min_diameter = 42 * gsd;
  site.rocks.max_diameter = 110 * gsd;
  site.rocks.k = abundance_for(random.uniform(3, 9), site.rocks.min_diameter, gsd * kPixels);
  site.rocks.clustering = 0;
  return site;
}

BoulderScene view_of(const testbed::SiteModel& model, double gsd, std::uint64_t seed, Random& random) {
  const testbed::Scene scene = testbed::make_scene(model, seed + 90000);
  const testbed::View view = testbed::map_view(scene, gsd, kPixels, kPixels);
  testbed::Exposure exposure;
  exposure.sun = {Degrees{random.uniform(0, 360)}, Degrees{random.uniform(18, 62)}, Degrees{0.5}};
  exposure.psf_sd = random.uniform(0.4, 1);
  exposure.haze = random.uniform(0, 0.2);
  exposure.skylight = random.uniform(0.02, 0.25);
  exposure.contrast = random.uniform(0.8, 1.5);
  BoulderScene made;
  made.view.elevation = to_radians(exposure.sun.elevation);
  made.view.sun_angle = testbed::image_sun_angle(view, exposure.sun);
  made.view.image.pixels = testbed::render_view(scene, view, exposure, seed);
  for (float& value : made.view.image.pixels.cells()) value = std::round(value * 255);
  for (const testbed::TrueRock& rock : scene.rocks)
    if (const auto outline = testbed::image_outline(view, rock))
      made.view.image.rocks.push_back({outline->x, outline->y, rock.width / gsd, rock.height / gsd,
                                       rock.height / gsd / std::tan(made.view.elevation.value)});
  for (const testbed::TrueCrater& crater : scene.craters)
    if (const auto outline = testbed::image_outline(view, crater)) made.craters.push_back(*outline);
  return made;
}

}  // namespace

BoulderScene boulder_scene(int number) {
  const auto seed = static_cast<std::uint64_t>(number);
  Random random(seed, "boulders");
  const double gsd = random.log_uniform(0.015, 0.06);
  return view_of(site(gsd, random), gsd, seed, random);
}

workflows::SyntheticView rock_field(int number) {
  const auto seed = static_cast<std::uint64_t>(number);
  Random random(seed, "rock field");
  const double gsd = random.log_uniform(0.06, 0.25);
  testbed::SiteModel field = site(gsd, random);
  field.craters.density = 0;
  field.rocks.min_diameter = 2 * gsd;
  field.rocks.max_diameter = 40 * gsd;
  field.rocks.k = random.log_uniform(0.05, 0.2);
  return view_of(field, gsd, seed, random).view;
}

}  // namespace waymark::test
