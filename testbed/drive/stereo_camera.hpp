// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/options.hpp"
#include "core/units.hpp"
#include "localization/depth_image.hpp"
#include "testbed/drive/ray_fan.hpp"
namespace waymark::testbed {

/// Depth camera: stereo pair or time of flight.
struct StereoModel {
  bool on = false;
  double every = 4;  ///< s between two images
  std::int64_t columns = 120, rows = 60;
  Degrees field{70};          ///< across the columns
  double height = 1.5;        ///< metres above the ground
  Degrees tilt{15};           ///< downwards
  double max_range = 18;      ///< metres
  double baseline = 0.3;      ///< metres; 0: time of flight, with an error independent of range
  double disparity_sd = 0.1;  ///< pixels of an image of 1000 columns
  double range_sd = 0.01;     ///< metres, independent of range; added to the disparity error
  double dropouts = 0.05;     ///< fraction of pixels without depth
  bool perfect = false;
};
void describe_stereo(StereoModel& stereo, OptionVisitor& field);

/// Returns depths along the optical axis. The camera looks forward, `tilt` below the robot axes.
localization::DepthImage depth_image(const RayFan& fan, const Eigen::Matrix3d& grid_from_robot,
                                     const StereoModel& stereo, Random& random);

}  // namespace waymark::testbed
