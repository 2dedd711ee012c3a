// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/panorama.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "localization/pose2.hpp"

namespace waymark::testbed {
namespace {

constexpr double kPrecision = 1e-5;  // radians, of the horizon

bool hits_terrain(const Terrain& terrain, const Eigen::Vector3d& eye, double azimuth, double elevation) {
  const Eigen::Vector3d along(std::cos(azimuth) * std::cos(elevation),
                              std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
  return terrain.cast({{eye}, {along}}).end == RayEnd::ground;
}

}  // namespace

std::vector<double> horizon(const Terrain& terrain, const Eigen::Vector3d& eye, double yaw,
                            const PanoramaModel& model, Random& random) {
  const auto count = static_cast<std::size_t>(std::lround(360 / model.step.value));
  std::vector<double> elevations(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double azimuth = yaw - std::numbers::pi + static_cast<double>(i) * to_radians(model.step).value;
    // Rays above one that misses the terrain miss, too.
    double low = -0.8, high = 1.2;
    while (high - low > kPrecision) {
      const double middle = (low + high) / 2;
      (hits_terrain(terrain, eye, azimuth, middle) ? low : high) = middle;
    }
    double seen = (low + high) / 2;
    if (!model.perfect) {
      seen += random.normal(0, to_radians(model.elevation_sd).value);
      if (random.bernoulli(model.dropouts)) seen = std::numeric_limits<double>::quiet_NaN();
    }
    elevations[i] = seen;
  }
  return elevations;
}

std::vector<BearingDetection> bearings(const LaserTargets& targets, const RayFan& fan, double yaw,
                                       const BearingModel& camera, double t, Random& random) {
  std::vector<BearingDetection> seen;
  const double half = to_radians(camera.field).value / 2;
  const double sd = camera.perfect ? 0 : to_radians(camera.bearing_sd).value;
  const double bias = camera.perfect ? 0 : to_radians(camera.bearing_bias).value;
  for (const auto& target : targets.near(fan.origin().head<2>(), camera.max_range)) {
    if (target.kind == TargetKind::thicket) continue;
    const bool rock = target.kind == TargetKind::rock;
    if (!rock && t >= targets.stems()[target.index].felled_at) continue;
    const Eigen::Vector3d aim =
        rock ? Eigen::Vector3d(targets.rocks()[target.index].foot +
                               Eigen::Vector3d(0, 0, 0.6 * targets.rocks()[target.index].top))
             : Eigen::Vector3d(targets.stems()[target.index].foot + Eigen::Vector3d(0, 0, 1.3));
    const double width = rock ? targets.rocks()[target.index].half_x + targets.rocks()[target.index].half_y
                              : targets.stems()[target.index].dbh;
    const Eigen::Vector3d to = aim - fan.origin();
    const double range = to.norm(), bearing = localization::wrap_angle(std::atan2(to.y(), to.x()) - yaw);
    if (range > camera.max_range || range < 0.5 || std::abs(bearing) > half ||
        width / range < to_radians(camera.min_size).value)
      continue;
    const auto hit = fan.cast(to / range);
    if (!hit || hit->kind != target.kind || hit->index != target.index) continue;
    if (!camera.perfect && random.bernoulli(camera.misses)) continue;
    seen.push_back({bearing + bias + random.normal(0, sd), target.kind});
  }
  if (!camera.perfect)
    for (std::uint64_t i = random.poisson(camera.clutter); i > 0; --i)
      seen.push_back({random.uniform(-half, half), seen.empty() ? TargetKind::rock : seen.front().kind});
  std::ranges::stable_sort(seen, std::greater<>{}, &BearingDetection::bearing);
  return seen;
}

void describe_panorama(PanoramaModel& p, OptionVisitor& field) {
  field("on", p.on, {.help = "Simulate skyline panoramas"});
  field("every", p.every, {.help = "Seconds between two panoramas", .min = 0.1, .max = 1e6});
  field("step", p.step, {.help = "Step between azimuths", .min = 0.01, .max = 30});
  field("height", p.height, {.help = "Metres above the ground", .min = 0.1, .max = 100});
  field("elevation_sd", p.elevation_sd, {.help = "Error of an elevation", .min = 0, .max = 10});
  field("dropouts", p.dropouts, {.help = "Fraction of azimuths without a horizon", .min = 0, .max = 1});
  field("perfect", p.perfect, {.help = "No error and no dropouts"});
}

void describe_bearing(BearingModel& b, OptionVisitor& field) {
  field("on", b.on, {.help = "Simulate a camera that measures bearings to landmarks"});
  field("every", b.every, {.help = "Seconds between two images", .min = 0.01, .max = 1e4});
  field("field", b.field, {.help = "Field of view", .min = 1, .max = 360});
  field("max_range", b.max_range,
        {.help = "Maximum range, metres", .min = 0.5, .max = 1e4, .formerly = "most_range"});
  field("height", b.height, {.help = "Metres above the ground", .min = 0.1, .max = 50});
  field("min_size", b.min_size,
        {.help = "Minimum apparent width of a detection", .min = 0, .max = 45, .formerly = "least_size"});
  field("bearing_sd", b.bearing_sd, {.help = "Error of a bearing", .min = 0, .max = 45});
  field("bearing_bias", b.bearing_bias, {.help = "Bias of all bearings to the left", .min = -45, .max = 45});
  field("misses", b.misses, {.help = "Fraction of objects in view that are missed", .min = 0, .max = 1});
  field("clutter", b.clutter, {.help = "False detections per image", .min = 0, .max = 1e3});
  field("perfect", b.perfect, {.help = "No error, misses or false detections"});
}

}  // namespace waymark::testbed
