// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <numbers>

#include "core/random.hpp"
#include "localization/global/constellation.hpp"
namespace waymark::testing {

/// What a sensor sees of a map from a place, with errors drawn from what it states of itself.
struct Look {
  double reach = 15, range_sd = 0.1, range_sd_per_metre = 0, bearing_sd = 0.01;
  double feature_sd = 0.1;  ///< part of the value, the feature 0
  double detected = 0.7;    ///< probability that a landmark in reach is seen
  double clutter = 0.1;     ///< false sightings per true one
};

struct LookedAt {
  SightingSet set;
  std::vector<int> truth;  ///< index of the landmark of each sighting, -1: false
};

/// `robot`: on the plane at `origin`; `places` as the index takes them.
inline LookedAt look(const std::vector<MapLandmark>& map, const std::vector<PlacedLandmark>& places,
                     const TangentPlane& plane, const Pose2& robot, const Look& how, Random& random) {
  LookedAt seen;
  const auto add = [&](double range, double bearing, TypeId type, double feature, int index) {
    SeenLandmark s;
    s.type = type;
    s.range_sd = how.range_sd + how.range_sd_per_metre * range;
    s.bearing_sd = how.bearing_sd;
    s.range = range + s.range_sd * random.normal();
    s.bearing = wrapped(bearing + s.bearing_sd * random.normal());
    if (std::isfinite(feature)) {
      s.features.value[0] = feature * std::exp(how.feature_sd * random.normal());
      s.features.variance[0] = std::pow(how.feature_sd * s.features.value[0], 2);
    }
    if (!(*s.range > 0)) return;
    seen.set.sightings.push_back(s);
    seen.truth.push_back(index);
  };
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Eigen::Vector3d d = places[i].at - plane.place(robot.at());
    if (d.norm() > how.reach || d.norm() < 1e-3 * how.reach || !random.chance(how.detected)) continue;
    const double bearing = std::atan2(plane.north.dot(d), plane.east.dot(d)) - robot.yaw;
    add(d.norm(), bearing, map[i].type, map[i].features.value[0], static_cast<int>(i));
  }
  const std::size_t real = seen.truth.size();
  for (std::size_t i = 0; i < real; ++i) {
    if (!random.chance(how.clutter)) continue;
    const MapLandmark& other = map[random.below(map.size())];
    add(how.reach * std::sqrt(random.uniform(0.01, 1)), random.uniform(-3.14, 3.14), other.type,
        other.features.value[0], -1);
  }
  return seen;
}

/// The same sightings with their bearings drawn anew: a constellation that is nowhere in the map.
inline SightingSet scrambled(SightingSet set, Random& random) {
  for (SeenLandmark& s : set.sightings) s.bearing = random.uniform(-std::numbers::pi, std::numbers::pi);
  return set;
}

/// How often a map answers rightly, wrongly, and not at all.
struct Tally {
  int right = 0, wrong = 0, unknown = 0, invented = 0, tries = 0;
  double seconds = 0, slowest = 0;
};

}  // namespace waymark::testing
