// SPDX-License-Identifier: Apache-2.0
#include "tests/rocks/made_view.hpp"

#include <cmath>

#include "core/random.hpp"
#include "testbed/render.hpp"
namespace waymark::testing {

MadeView made_view(int number) {
  Random random(static_cast<std::uint64_t>(number), "made view of rocks");
  constexpr double kGsd = 0.3;
  Ground ground;
  ground.width = ground.height = 200;
  ground.cell = 0.5;
  ground.rocks.k = random.log_uniform(0.006, 0.3);
  ground.rocks.min_diameter = 0.35;
  ground.rocks.max_diameter = random.uniform(3, 8);
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
  const Scene scene = make_scene(ground, static_cast<std::uint64_t>(number));
  const View view = map_view(scene, kGsd, 448, 448);
  const double incidence = random.uniform(30, 75);
  Exposure exposure;
  exposure.sun = {Degrees{random.uniform(0, 360)}, Degrees{90 - incidence}, Degrees{0.5}};
  exposure.psf_sd = random.uniform(0.4, 1.0);
  exposure.haze = random.uniform(0, 0.2);
  exposure.skylight = random.uniform(0.02, 0.25);
  exposure.read_noise = random.log_uniform(0.001, 0.006);
  MadeView made;
  made.elevation = to_radians(exposure.sun.elevation);
  made.sun_angle = image_sun_angle(view, exposure.sun);
  made.image.pixels = render_view(scene, view, exposure, static_cast<std::uint64_t>(number));
  for (float& value : made.image.pixels.cells()) value = std::round(value * 255);
  for (const TrueRock& rock : scene.rocks)
    if (const auto outline = outline_in(view, rock))
      made.image.rocks.push_back({outline->x, outline->y, rock.width / kGsd, rock.height / kGsd,
                                  rock.height / kGsd / std::tan(made.elevation.value)});
  return made;
}

}  // namespace waymark::testing
