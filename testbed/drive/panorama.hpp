// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/options.hpp"
#include "core/units.hpp"
#include "testbed/drive/ray_fan.hpp"
namespace waymark {

/// A camera that turns round and sees where the ground ends and the sky begins.
struct PanoramaModel {
  bool on = false;
  double every = 60;    ///< s
  Degrees step{0.5};    ///< between azimuths
  double height = 1.5;  ///< metres above the ground
  Degrees elevation_sd{0.05};
  double dropouts = 0.02;  ///< share of azimuths without a horizon
  bool perfect = false;
};
void describe_panorama(PanoramaModel& panorama, OptionVisitor& field);

/// Elevation of the horizon, radians, at azimuths -pi, -pi + step, ... left of forward; NaN where it was not
/// found. Levelled. The terrain alone makes it, without refraction.
std::vector<double> horizon(const Terrain& terrain, const Eigen::Vector3d& eye, double yaw,
                            const PanoramaModel& panorama, Random& random);

/// A camera that measures directions to rocks (or stems), but no ranges.
struct BearingModel {
  bool on = false;
  double every = 4;  ///< s
  Degrees field{90};
  double most_range = 25;   ///< metres
  double height = 1.5;      ///< metres above the ground
  Degrees least_size{0.8};  ///< apparent width of what is seen
  Degrees bearing_sd{0.3};
  Degrees bearing_bias{0};
  double misses = 0.2;   ///< share of things in view that are missed
  double clutter = 0.3;  ///< false sightings per image
  bool perfect = false;
};
void describe_bearing(BearingModel& camera, OptionVisitor& field);

struct SeenBearing {
  double bearing = 0;
  TargetKind kind = TargetKind::rock;
};
/// What the camera sees, from the left to the right. A thing is in view where the ray to the middle of its
/// upper half meets it first.
std::vector<SeenBearing> bearings(const LaserTargets& targets, const RayFan& fan, double yaw,
                                  const BearingModel& camera, double t, Random& random);

}  // namespace waymark
