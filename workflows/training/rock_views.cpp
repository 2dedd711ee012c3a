// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/rock_views.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "testbed/render.hpp"
namespace waymark::workflows {
namespace {

/// Outcrops, dunes, how many craters there are, and relief.
void draw_terrain(testbed::SiteModel& ground, Random& random) {
  if (random.bernoulli(0.2)) ground.outcrops.cover = random.uniform(0, 0.03);
  ground.dunes.cover = random.uniform(0, 0.4);
  ground.dunes.wavelength = random.log_uniform(4, 20);
  ground.dunes.height = ground.dunes.wavelength * random.uniform(0.03, 0.09);
  ground.craters.density = random.uniform(0, 0.6);
  ground.relief.slope = std::tan(random.uniform(0, 0.2));
  ground.relief.slope_azimuth = {random.uniform(0, 360)};
  ground.relief.rms = random.log_uniform(0.3, 5);
  ground.relief.longest = 300;
}

}  // namespace

SyntheticView synthetic_view(int number) {
  Random random(static_cast<std::uint64_t>(number), "made view of rocks");
  constexpr std::int64_t kPixels = 448;
  const double gsd = random.log_uniform(0.1, 0.5);  // the finer, the more of the ground's texture is seen
  testbed::SiteModel ground;
  ground.width = ground.height = 1.5 * gsd * kPixels;
  ground.cell = random.uniform(1.5, 4) * gsd;
  ground.rocks.k = random.log_uniform(0.006, 0.3);
  ground.rocks.min_diameter = 1.2 * gsd;
  ground.rocks.max_diameter = random.uniform(8, 25) * gsd;
  ground.relief.roughness = random.log_uniform(0.3, 1.5);
  draw_terrain(ground, random);
  ground.craters.min_diameter = 3;
  ground.craters.max_diameter = 80;
  // Every third view: ground whose texture is strong and whose small rocks are few, as landings meet.
  Random other(static_cast<std::uint64_t>(number), "rough views without gravel");
  const bool bare = number % 3 == 2;
  if (bare) {
    ground.rocks.min_diameter = gsd * other.log_uniform(1.5, 6);
    ground.rocks.max_diameter = std::max(ground.rocks.max_diameter, 4 * ground.rocks.min_diameter);
    ground.rocks.k = other.log_uniform(0.02, 0.3);
    ground.relief.roughness = other.log_uniform(0.6, 2);
  }
  const testbed::Scene scene = testbed::make_scene(ground, static_cast<std::uint64_t>(number));
  const testbed::View view = testbed::map_view(scene, gsd, kPixels, kPixels);
  const double incidence = random.uniform(30, 75);
  testbed::Exposure exposure;
  exposure.sun = {Degrees{random.uniform(0, 360)}, Degrees{90 - incidence}, Degrees{0.5}};
  exposure.psf_sd = random.uniform(0.4, 1.0);
  exposure.haze = random.uniform(0, 0.2);
  exposure.skylight = random.uniform(0.02, 0.25);
  exposure.read_noise = random.log_uniform(0.001, 0.006);
  exposure.contrast = random.uniform(0.8, 1.8);
  if (bare) exposure.contrast = other.uniform(1, 2);
  SyntheticView made;
  made.elevation = to_radians(exposure.sun.elevation);
  made.sun_angle = testbed::image_sun_angle(view, exposure.sun);
  made.image.pixels = testbed::render_view(scene, view, exposure, static_cast<std::uint64_t>(number));
  for (float& value : made.image.pixels.cells()) value = std::round(value * 255);
  for (const testbed::TrueRock& rock : scene.rocks)
    if (const auto outline = testbed::image_outline(view, rock))
      made.image.rocks.push_back({outline->x, outline->y, rock.width / gsd, rock.height / gsd,
                                  rock.height / gsd / std::tan(made.elevation.value)});
  return made;
}

SyntheticView leaning_view(int number) {
  Random random(static_cast<std::uint64_t>(number), "leaning view of rocks");
  constexpr std::int64_t kPixels = 448;
  const double gsd = random.log_uniform(0.05, 0.4);
  testbed::SiteModel ground;
  ground.width = ground.height = 2.4 * gsd * kPixels;
  ground.cell = random.uniform(1.5, 4) * gsd;
  ground.rocks.k = random.log_uniform(0.01, 0.3);
  ground.rocks.min_diameter = gsd * (random.bernoulli(0.5) ? random.log_uniform(1.5, 6) : 1.2);
  ground.rocks.max_diameter = std::max(4 * ground.rocks.min_diameter, random.uniform(8, 40) * gsd);
  ground.relief.roughness = random.log_uniform(0.3, 2);
  draw_terrain(ground, random);
  ground.craters.min_diameter = std::max(2.0, 8 * gsd);
  ground.craters.max_diameter = 80;
  const testbed::Scene scene = testbed::make_scene(ground, static_cast<std::uint64_t>(number) + 50000);

  PosedCamera camera;
  camera.camera.columns = camera.camera.rows = kPixels;
  const double field = to_radians(Degrees{random.log_uniform(8, 50)}).value;
  camera.camera.fx = camera.camera.fy = 0.5 * kPixels / std::tan(field / 2);
  camera.camera.cx = camera.camera.cy = 0.5 * (kPixels - 1);
  const double tilt = random.uniform(0, 0.38), heading = random.uniform(0, 6.283185307179586),
               roll = random.uniform(0, 6.283185307179586);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(3.141592653589793 - tilt, Eigen::Vector3d::UnitX()) *
                   Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()))
                      .toRotationMatrix();
  const Eigen::Vector3d middle(ground.east, ground.north,
                               scene.terrain.height(ground.east, ground.north).value_or(ground.up));
  pose.translation() = middle - gsd * camera.camera.fx * pose.linear().col(2);
  camera.grid_from_camera.transform = pose;
  const testbed::View view = testbed::camera_view(camera);

  const double elevation = random.bernoulli(0.3) ? random.uniform(14, 25) : random.uniform(14, 62);
  testbed::Exposure exposure;
  exposure.sun = {Degrees{random.uniform(0, 360)}, Degrees{elevation}, Degrees{0.5}};
  exposure.psf_sd = random.uniform(0.4, 1.0);
  exposure.haze = random.uniform(0, 0.2);
  exposure.skylight = random.uniform(0.02, 0.25);
  exposure.read_noise = random.log_uniform(0.001, 0.006);
  exposure.contrast = random.uniform(0.8, 1.8);
  SyntheticView made;
  made.elevation = to_radians(exposure.sun.elevation);
  made.sun_angle = testbed::image_sun_angle(view, exposure.sun);
  made.displacement = pipeline::relief_displacement_of(camera);
  made.image.pixels = testbed::render_view(scene, view, exposure, static_cast<std::uint64_t>(number));
  for (float& value : made.image.pixels.cells()) value = std::round(value * 255);
  const Eigen::Vector3d light = sun_direction(exposure.sun).unit;
  for (const testbed::TrueRock& rock : scene.rocks) {
    const auto outline = testbed::image_outline(view, rock);
    if (!outline) continue;
    const Eigen::Vector3d step = 0.05 * Eigen::Vector3d(light.x(), light.y(), 0).normalized();
    const auto from = project(camera, Point<GridFrame>{rock.position - step});
    const auto to = project(camera, Point<GridFrame>{rock.position + step});
    if (!from || !to) continue;
    const double diameter = std::sqrt(outline->major * outline->minor);
    made.image.rocks.push_back(
        {outline->x, outline->y, diameter, rock.height * diameter / rock.width,
         rock.height / std::tan(made.elevation.value) * (*to - *from).norm() / (2 * step.norm())});
  }
  std::stable_sort(made.image.rocks.begin(), made.image.rocks.end(),
                   [](const auto& a, const auto& b) { return a.diameter > b.diameter; });
  return made;
}

}  // namespace waymark::workflows
