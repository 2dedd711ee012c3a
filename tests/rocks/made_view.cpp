// SPDX-License-Identifier: Apache-2.0
#include "tests/rocks/made_view.hpp"

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "testbed/render.hpp"
namespace waymark::testing {

MadeView made_view(int number) {
  Random random(static_cast<std::uint64_t>(number), "made view of rocks");
  constexpr std::int64_t kPixels = 448;
  const double gsd = random.log_uniform(0.1, 0.5);  // the finer, the more of the ground's texture is seen
  MadeGround ground;
  ground.width = ground.height = 1.5 * gsd * kPixels;
  ground.cell = random.uniform(1.5, 4) * gsd;
  ground.rocks.k = random.log_uniform(0.006, 0.3);
  ground.rocks.min_diameter = 1.2 * gsd;
  ground.rocks.max_diameter = random.uniform(8, 25) * gsd;
  ground.relief.roughness = random.log_uniform(0.3, 1.5);
  if (random.chance(0.2)) ground.outcrops.cover = random.uniform(0, 0.03);
  ground.dunes.cover = random.uniform(0, 0.4);
  ground.dunes.wavelength = random.log_uniform(4, 20);
  ground.dunes.height = ground.dunes.wavelength * random.uniform(0.03, 0.09);
  ground.craters.density = random.uniform(0, 0.6);
  ground.craters.min_diameter = 3;
  ground.craters.max_diameter = 80;
  ground.relief.slope = std::tan(random.uniform(0, 0.2));
  ground.relief.slope_azimuth = {random.uniform(0, 360)};
  ground.relief.rms = random.log_uniform(0.3, 5);
  ground.relief.longest = 300;
  // Every third view: ground whose texture is strong and whose small rocks are few, as landings meet.
  Random other(static_cast<std::uint64_t>(number), "rough views without gravel");
  const bool bare = number % 3 == 2;
  if (bare) {
    ground.rocks.min_diameter = gsd * other.log_uniform(1.5, 6);
    ground.rocks.max_diameter = std::max(ground.rocks.max_diameter, 4 * ground.rocks.min_diameter);
    ground.rocks.k = other.log_uniform(0.02, 0.3);
    ground.relief.roughness = other.log_uniform(0.6, 2);
  }
  const Scene scene = make_scene(ground, static_cast<std::uint64_t>(number));
  const View view = map_view(scene, gsd, kPixels, kPixels);
  const double incidence = random.uniform(30, 75);
  Exposure exposure;
  exposure.sun = {Degrees{random.uniform(0, 360)}, Degrees{90 - incidence}, Degrees{0.5}};
  exposure.psf_sd = random.uniform(0.4, 1.0);
  exposure.haze = random.uniform(0, 0.2);
  exposure.skylight = random.uniform(0.02, 0.25);
  exposure.read_noise = random.log_uniform(0.001, 0.006);
  exposure.contrast = random.uniform(0.8, 1.8);
  if (bare) exposure.contrast = other.uniform(1, 2);
  MadeView made;
  made.elevation = to_radians(exposure.sun.elevation);
  made.sun_angle = image_sun_angle(view, exposure.sun);
  made.image.pixels = render_view(scene, view, exposure, static_cast<std::uint64_t>(number));
  for (float& value : made.image.pixels.cells()) value = std::round(value * 255);
  for (const TrueRock& rock : scene.rocks)
    if (const auto outline = outline_in(view, rock))
      made.image.rocks.push_back({outline->x, outline->y, rock.width / gsd, rock.height / gsd,
                                  rock.height / gsd / std::tan(made.elevation.value)});
  return made;
}

}  // namespace waymark::testing
