// SPDX-License-Identifier: Apache-2.0
#include "localization/line_of_sight.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace waymark::localization {
namespace {

constexpr double kChord = 1000;  // m

}  // namespace

void LineOfSightOptions::describe(OptionVisitor& option) {
  option("sensor_height", sensor_height,
         {.help = "With --dem: height of the sensor above the ground, metres, for occlusion",
          .min = 0,
          .max = 100});
  option("landmark_height", landmark_height,
         {.help = "With --dem: height of a landmark that must be visible, metres", .min = 0, .max = 100});
  option("line_of_sight_step", step,
         {.help = "With --dem: metres between terrain samples along a line of sight",
          .min = 0.01,
          .max = 100,
          .formerly = "sight_step"});
}

LineOfSight terrain_line_of_sight(TerrainHeight ground, const LineOfSightOptions& options) {
  if (!ground) return {};
  return [ground = std::move(ground), options](const Pose2& sensor, const Eigen::Vector2d& landmark) {
    const auto from = ground(sensor.at()), to = ground(landmark);
    if (!from || !to) return true;
    const double distance = (landmark - sensor.at()).norm();
    const double eye = *from + options.sensor_height;
    const double rise = (*to + options.landmark_height - eye) / std::max(distance, 1e-9);
    // The last step belongs to the landmark: the ground below it does not hide it.
    for (double t = options.step; t < distance - options.step; t += options.step) {
      const auto height = ground(sensor.at() + (landmark - sensor.at()) * (t / distance));
      if (height && *height > eye + rise * t) return false;
    }
    return true;
  };
}

LineOfSight terrain_line_of_sight(const Terrain& terrain, const LineOfSightOptions& options,
                                  double body_radius, double refraction) {
  const double margin = std::max({options.step, terrain.step_x(), terrain.step_y()});
  const double bend = curvature_drop(1, body_radius, refraction);
  return [terrain, options, margin, bend](const Pose2& sensor, const Eigen::Vector2d& landmark) {
    const auto from = terrain.height(sensor.x, sensor.y), to = terrain.height(landmark.x(), landmark.y());
    if (!from || !to) return true;
    const double distance = (landmark - sensor.at()).norm();
    const double begin = options.step, length = distance - margin - begin;
    if (!(length > 0)) return true;
    const double eye = *from + options.sensor_height, target = *to + options.landmark_height;
    // Heights above the curved surface are lowest in the middle of the line: chords of 1 km err by 2 cm.
    const auto point = [&](double t) {
      const Eigen::Vector2d at = sensor.at() + (landmark - sensor.at()) * (t / distance);
      return Point<GridFrame>{
          {at.x(), at.y(), eye + (target - eye) * (t / distance) - bend * t * (distance - t)}};
    };
    const double chords = bend > 0 ? std::ceil(length / kChord) : 1;
    Point<GridFrame> last = point(begin);
    for (double i = 1; i <= chords; ++i) {
      const Point<GridFrame> next = point(begin + length * i / chords);
      if (terrain.reaches(last, next)) return false;
      last = next;
    }
    return true;
  };
}

bool is_hidden(const Pose2& sensor, const Eigen::Matrix2d& covariance, const Eigen::Vector2d& landmark,
               const LineOfSight& visible) {
  if (!visible || visible(sensor, landmark)) return false;
  // Axes of the ellipse: half the difference of the eigenvalues along the angle of the larger one.
  const double mean = covariance.trace() / 2;
  const double half = std::hypot((covariance(0, 0) - covariance(1, 1)) / 2, covariance(0, 1));
  const double angle = std::atan2(2 * covariance(0, 1), covariance(0, 0) - covariance(1, 1)) / 2;
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
  for (const auto& [axis, variance] : {std::pair(along, mean + half), std::pair(across, mean - half)})
    for (const double sigmas : {-2.0, 2.0}) {
      const Eigen::Vector2d at = sensor.at() + sigmas * std::sqrt(std::max(0.0, variance)) * axis;
      if (visible({at.x(), at.y(), sensor.yaw}, landmark)) return false;
    }
  return true;
}

std::vector<std::uint32_t> hidden_landmarks(const Pose2& sensor, const LandmarkGrid& map, double range,
                                            const LineOfSight& visible) {
  std::vector<std::uint32_t> hidden;
  if (!visible) return hidden;
  map.near(sensor.at(), range, [&](std::uint32_t i) {
    if (!visible(sensor, map[i].at)) hidden.push_back(i);
  });
  std::ranges::sort(hidden);
  return hidden;
}

bool RangeProfile::reaches(double bearing, double half_width, double range) const {
  const double step = std::abs(angle_step);
  if (ranges.empty() || !(step > 0)) return false;
  const double last = step * static_cast<double>(ranges.size() - 1);  // rad, from the rightmost beam
  const double middle = first_angle + (angle_step > 0 ? last : -last) / 2;
  const double offset = wrap_angle(bearing - middle) + last / 2, width = std::max(half_width, step / 2);
  if (!(offset - width >= -step / 2 && offset + width <= last + step / 2)) return false;
  const auto from = static_cast<std::size_t>(std::max(0.0, std::ceil((offset - width) / step)));
  const auto to = static_cast<std::size_t>(std::min(last / step, std::floor((offset + width) / step)));
  for (std::size_t i = from; i <= to; ++i) {
    const float seen = ranges[angle_step > 0 ? i : ranges.size() - 1 - i];
    if (seen > 0 && static_cast<double>(seen) < range) return false;
  }
  return true;
}

}  // namespace waymark::localization
