// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/laser_scanner.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace waymark::testbed {
namespace {

constexpr double kRangeResolution = 0.25;  // metres, range resolution of one pulse
constexpr std::size_t kMaxRays = 31;

// Range measured by a beam whose rays end at these ranges, ascending; rays without hit are left out.
double measured_range(std::span<const double> ranges, std::size_t rays, const LaserModel& laser,
                      Random& random) {
  const double enough = std::max(1.0, laser.sensitivity * static_cast<double>(rays));
  for (std::size_t first = 0; first < ranges.size();) {
    std::size_t end = first;
    double sum = 0;
    while (end < ranges.size() && ranges[end] - ranges[first] <= kRangeResolution) sum += ranges[end++];
    const double count = static_cast<double>(end - first), mean = sum / count;
    if (count >= enough) {
      const bool edge = end < ranges.size() && ranges[end] - mean < 2;
      if (!edge || !random.bernoulli(laser.mixed)) return mean;
      return mean + random.uniform() * (ranges[end] - mean);
    }
    first = end;
  }
  return 0;
}

}  // namespace

std::int64_t LaserModel::beams() const {
  return static_cast<std::int64_t>(std::floor(field.value / step.value + 1e-9)) + 1;
}

LaserModel LaserModel::ideal_model() const {
  LaserModel exact = *this;
  exact.divergence = Degrees{0};
  exact.rays = 1;
  exact.range_bias = exact.range_sd = exact.dropouts = exact.clutter = exact.mixed = 0;
  exact.tilt_sd = Degrees{0};
  return exact;
}

localization::LaserScan sweep(const RayFan& fan, const Eigen::Matrix3d& grid_from_sensor,
                              const LaserModel& laser, Random& random) {
  const RayCast cast = [&](const Eigen::Vector3d& along) {
    const auto hit = fan.cast(along, &random);
    return hit ? std::optional(hit->range) : std::nullopt;
  };
  return sweep(cast, grid_from_sensor, laser, random);
}

localization::LaserScan sweep(const RayCast& cast, const Eigen::Matrix3d& grid_from_sensor,
                              const LaserModel& given, Random& random) {
  const LaserModel laser = given.perfect ? given.ideal_model() : given;
  localization::LaserScan scan;
  const std::int64_t beams = laser.beams();
  scan.angle_step = to_radians(laser.step).value;
  scan.first_angle = -0.5 * scan.angle_step * static_cast<double>(beams - 1);
  scan.max_range = laser.max_range;
  scan.ranges.resize(static_cast<std::size_t>(beams));
  const auto rays = std::clamp<std::size_t>(static_cast<std::size_t>(laser.rays), 1, kMaxRays);
  const double width = to_radians(laser.divergence).value;
  std::array<double, kMaxRays> hits{};
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < rays; ++k) {
      const double within = (static_cast<double>(k) + 0.5) / static_cast<double>(rays) - 0.5;
      const double angle = scan.first_angle + static_cast<double>(i) * scan.angle_step + within * width;
      const Eigen::Vector3d along = grid_from_sensor * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
      if (const auto range = cast(along)) hits[count++] = *range;
    }
    std::sort(hits.begin(), hits.begin() + static_cast<std::ptrdiff_t>(count));
    double range = count > 0 ? measured_range({hits.data(), count}, rays, laser, random) : 0;
    if (range > 0) range += laser.range_bias + random.normal(0, laser.range_sd);
    if (random.bernoulli(laser.dropouts)) range = 0;
    if (random.bernoulli(laser.clutter)) range = random.uniform(0.3, laser.max_range);
    scan.ranges[i] = range > 0 && range < laser.max_range ? static_cast<float>(range) : 0.0F;
  }
  return scan;
}

void describe_laser(LaserModel& l, OptionVisitor& field) {
  field("on", l.on, {.help = "Simulate a line scanner"});
  field("every", l.every, {.help = "Seconds between two scans", .min = 0.01, .max = 1e4});
  field("field", l.field, {.help = "Angle from the first beam to the last", .min = 1, .max = 360});
  field("step", l.step, {.help = "Angle between two beams", .min = 0.01, .max = 10});
  field("max_range", l.max_range,
        {.help = "Maximum range, metres", .min = 0.5, .max = 1000, .formerly = "most_range"});
  field("divergence", l.divergence, {.help = "Full divergence of a beam", .min = 0, .max = 5});
  field("rays", l.rays, {.help = "Rays cast across the width of a beam", .min = 1, .max = 31});
  field("sensitivity", l.sensitivity,
        {.help = "Minimum fraction of a beam that an object must intercept", .min = 0, .max = 1});
  field("range_bias", l.range_bias, {.help = "Bias of a range, metres", .min = -10, .max = 10});
  field("range_sd", l.range_sd, {.help = "Noise of a range, metres", .min = 0, .max = 10});
  field("dropouts", l.dropouts, {.help = "Fraction of beams without return", .min = 0, .max = 1});
  field("clutter", l.clutter, {.help = "Fraction of beams with a false range", .min = 0, .max = 1});
  field(
      "mixed", l.mixed,
      {.help = "Fraction of beams on an edge that return a range between both objects", .min = 0, .max = 1});
  field("levelled", l.levelled, {.help = "Levelled mount; false: tilts with the vehicle"});
  field("tilt_sd", l.tilt_sd, {.help = "Error of roll and pitch in the log", .min = 0, .max = 10});
  field("perfect", l.perfect, {.help = "No beam width, noise, dropouts or clutter"});
}

}  // namespace waymark::testbed
