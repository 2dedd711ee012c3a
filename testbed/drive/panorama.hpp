// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/options.hpp"
#include "core/units.hpp"
#include "testbed/drive/ray_fan.hpp"
namespace waymark::testbed {

/// Rotating camera that measures the skyline.
struct PanoramaModel {
  bool on = false;
  double every = 60;    ///< s
  Degrees step{0.5};    ///< between azimuths
  double height = 1.5;  ///< metres above the ground
  Degrees elevation_sd{0.05};
  double dropouts = 0.02;  ///< fraction of azimuths without a horizon
  bool perfect = false;
};
void describe_panorama(PanoramaModel& panorama, OptionVisitor& field);

/// Returns the elevation of the horizon, radians, at azimuths -pi, -pi + step, ... left of forward; NaN
/// where it is missing. Levelled. Computed from the terrain alone, without refraction.
std::vector<double> horizon(const Terrain& terrain, const Eigen::Vector3d& eye, double yaw,
                            const PanoramaModel& panorama, Random& random);

/// Camera that measures bearings to rocks or stems, without ranges.
struct BearingModel {
  bool on = false;
  double every = 4;  ///< s
  Degrees field{90};
  double max_range = 25;  ///< metres
  double height = 1.5;    ///< metres above the ground
  Degrees min_size{0.8};  ///< minimum apparent width of a detection
  Degrees bearing_sd{0.3};
  Degrees bearing_bias{0};
  double misses = 0.2;   ///< fraction of objects in view that are missed
  double clutter = 0.3;  ///< false detections per image
  bool perfect = false;
};
void describe_bearing(BearingModel& camera, OptionVisitor& field);

struct BearingDetection {
  double bearing = 0;
  TargetKind kind = TargetKind::rock;
};
/// Returns the detections of the camera from left to right. An object is in view if the ray to the centre
/// of its upper half hits it first.
std::vector<BearingDetection> bearings(const LaserTargets& targets, const RayFan& fan, double yaw,
                                       const BearingModel& camera, double t, Random& random);

}  // namespace waymark::testbed
