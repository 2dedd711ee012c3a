// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <numbers>

#include "core/random.hpp"
#include "localization/global/constellation.hpp"
namespace waymark::test {
using namespace localization;

/// Model of a sensor; errors are drawn from the stated standard deviations.
struct SensorModel {
  double reach = 15, range_sd = 0.1, range_sd_per_metre = 0, bearing_sd = 0.01;
  double feature_sd = 0.1;  ///< relative, of feature 0
  double detected = 0.7;    ///< probability that a landmark in range is seen
  double clutter = 0.1;     ///< false sightings per true one
};

struct SimulatedSightings {
  SightingSet set;
  std::vector<int> truth;  ///< index of the landmark of each sighting, -1: false
};

/// Simulates one set of sightings. `robot`: on the plane; `positions` as the index takes them.
inline SimulatedSightings look(const std::vector<MapLandmark>& map,
                               const std::vector<LandmarkPosition>& positions, const TangentPlane& plane,
                               const Pose2& robot, const SensorModel& how, Random& random) {
  SimulatedSightings seen;
  const auto add = [&](double range, double bearing, TypeId type, double feature, int index) {
    SeenLandmark s;
    s.type = type;
    s.range_sd = how.range_sd + how.range_sd_per_metre * range;
    s.bearing_sd = how.bearing_sd;
    s.range = range + s.range_sd * random.normal();
    s.bearing = wrap_angle(bearing + s.bearing_sd * random.normal());
    if (std::isfinite(feature)) {
      s.features.value[0] = feature * std::exp(how.feature_sd * random.normal());
      s.features.variance[0] = std::pow(how.feature_sd * s.features.value[0], 2);
    }
    if (!(*s.range > 0)) return;
    seen.set.sightings.push_back(s);
    seen.truth.push_back(index);
  };
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Eigen::Vector3d d = positions[i].at - plane.point(robot.at());
    if (d.norm() > how.reach || d.norm() < 1e-3 * how.reach || !random.bernoulli(how.detected)) continue;
    const double bearing = std::atan2(plane.north.dot(d), plane.east.dot(d)) - robot.yaw;
    add(d.norm(), bearing, map[i].type, map[i].features.value[0], static_cast<int>(i));
  }
  const std::size_t real = seen.truth.size();
  for (std::size_t i = 0; i < real; ++i) {
    if (!random.bernoulli(how.clutter)) continue;
    const MapLandmark& other = map[random.uniform_index(map.size())];
    add(how.reach * std::sqrt(random.uniform(0.01, 1)), random.uniform(-3.14, 3.14), other.type,
        other.features.value[0], -1);
  }
  return seen;
}

/// Returns the same sightings with random bearings: a constellation that is not in the map.
inline SightingSet scramble_bearings(SightingSet set, Random& random) {
  for (SeenLandmark& s : set.sightings) s.bearing = random.uniform(-std::numbers::pi, std::numbers::pi);
  return set;
}

/// Counts of right, wrong and missing answers.
struct Tally {
  int right = 0, wrong = 0, unknown = 0, invented = 0, tries = 0;
  double seconds = 0, slowest = 0;
};

}  // namespace waymark::test
