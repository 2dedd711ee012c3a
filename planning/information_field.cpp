// SPDX-License-Identifier: Apache-2.0
#include "planning/information_field.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.hpp"

namespace waymark::planning {
namespace {

constexpr double kMinRange = 0.1;  // m: nearer, a bearing has no direction

}  // namespace

void visit_information(const localization::Pose2& pose, const localization::LandmarkGrid& map,
                       const LandmarkSensing& sensing, const VisitInformation& visit) {
  const SensorCoverage& sensor = sensing.coverage;
  const double half_view = sensor.view / 2 * kRadiansPerDegree;
  const double correlation = sensing.correlation_per_range * sensor.range;
  map.near(pose.at(), sensor.range, [&](std::uint32_t i) {
    const localization::MapLandmark& landmark = map[i];
    const Eigen::Vector2d to = landmark.at - pose.at();
    const double r = to.norm();
    if (!(r > kMinRange)) return;
    if (half_view < std::numbers::pi &&
        std::abs(localization::wrap_angle(std::atan2(to.y(), to.x()) - pose.yaw)) > half_view)
      return;
    if (sensing.visible && !sensing.visible(pose, landmark.at)) return;
    const Eigen::Vector2d u = to / r, w(-u.y(), u.x());
    const Eigen::Matrix2d& s = landmark.covariance;
    const double rate = sensing.sightings_per_metre, bearing_sd = sensor.bearing_sd * kRadiansPerDegree;
    const double bearing = bearing_sd * bearing_sd / rate + 2 * correlation * w.dot(s * w) / (r * r);
    // The bearing's row of the measurement matrix is (-w / r, -1), that of the range (-u, 0).
    Symmetric3 j;
    const double detection = detection_probability(sensor, r, landmark.diameter);
    const double b = detection / bearing;
    add(j,
        {w.x() * w.x() / (r * r), w.x() * w.y() / (r * r), w.y() * w.y() / (r * r), w.x() / r, w.y() / r, 1},
        b);
    if (sensor.range_sd > 0) {
      const double range = sensor.range_sd * sensor.range_sd / rate + 2 * correlation * u.dot(s * u);
      add(j, {u.x() * u.x(), u.x() * u.y(), u.y() * u.y(), 0, 0, 0}, detection / range);
    }
    visit(i, j);
  });
}

LandmarkSensing sensing_at_one_position(const LandmarkSensing& sensing) {
  LandmarkSensing once = sensing;
  if (!sensing.visible || !(sensing.coverage.view < 360)) return once;
  once.visible = [&visible = sensing.visible, tested = std::vector<std::pair<Eigen::Vector2d, bool>>()](
                     const localization::Pose2& pose, const Eigen::Vector2d& landmark) mutable {
    const auto found = std::ranges::find(tested, landmark, &std::pair<Eigen::Vector2d, bool>::first);
    if (found != tested.end()) return found->second;
    return tested.emplace_back(landmark, visible(pose, landmark)).second;
  };
  return once;
}

Information information_at(const localization::Pose2& pose, const localization::LandmarkGrid& map,
                           const LandmarkSensing& sensing) {
  Information sum;
  visit_information(pose, map, sensing, [&](std::uint32_t i, const Symmetric3& information) {
    if (map[i].quality < sensing.min_confidence) return;
    add(sum.rate, information, map[i].quality);
    ++sum.landmarks;
    sum.quality += map[i].paper_quality;
  });
  return sum;
}

localization::Pose2 heading_pose(double x, double y, int heading) {
  return {x, y, localization::wrap_angle(heading * std::numbers::pi / 4)};
}

std::int64_t RouteCells::index(double px, double py) const {
  const double c = std::floor((px - x0) / cell + 0.5), r = std::floor((py - y0) / cell + 0.5);
  if (!(c >= 0 && r >= 0 && c < static_cast<double>(columns) && r < static_cast<double>(rows))) return -1;
  return static_cast<std::int64_t>(r) * columns + static_cast<std::int64_t>(c);
}

void visit_cells(const RouteCells& cells, const std::vector<char>& passable, const LandmarkSensing& sensing,
                 const VisitCell& visit) {
  const int headings = informative_headings(sensing);
  const auto visit_row = [&](std::int64_t row) {
    for (std::int64_t i = row * cells.columns; i < (row + 1) * cells.columns; ++i) {
      if (!passable[static_cast<std::size_t>(i)]) continue;
      const LandmarkSensing here = sensing_at_one_position(sensing);
      for (int h = 0; h < headings; ++h) visit(i, h, here);
    }
  };
  if (sensing.visible) {
    for (std::int64_t row = 0; row < cells.rows; ++row) visit_row(row);
  } else {
    tbb::parallel_for(std::int64_t{0}, cells.rows, visit_row);
  }
}

InformationField make_information_field(const RouteCells& cells, const std::vector<char>& passable,
                                        const localization::LandmarkGrid& map,
                                        const LandmarkSensing& sensing) {
  InformationField field{cells, informative_headings(sensing), {}};
  field.at.resize(static_cast<std::size_t>(cells.count() * field.headings));
  visit_cells(cells, passable, sensing, [&](std::int64_t i, int h, const LandmarkSensing& here) {
    field.at[static_cast<std::size_t>(i * field.headings + h)] =
        information_at(heading_pose(cells.x(i), cells.y(i), h), map, here);
  });
  return field;
}

}  // namespace waymark::planning
