// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/stereo_camera.hpp"

#include <cmath>

namespace waymark::testbed {

localization::DepthImage depth_image(const RayFan& fan, const Eigen::Matrix3d& grid_from_robot,
                                     const StereoModel& stereo, Random& random) {
  localization::DepthImage image;
  image.columns = stereo.columns;
  image.rows = stereo.rows;
  image.height = stereo.height;
  image.tilt = to_radians(stereo.tilt).value;
  image.focal = 0.5 * double(stereo.columns) / std::tan(to_radians(stereo.field).value / 2);
  image.depths.reserve(static_cast<std::size_t>(stereo.columns * stereo.rows));
  const Eigen::Matrix3d turn =
      grid_from_robot * Eigen::AngleAxisd(image.tilt, Eigen::Vector3d::UnitY()).toRotationMatrix();
  // Focal length of an image of 1000 columns with the same field of view.
  const double fine_focal = image.focal * 1000 / double(stereo.columns);
  for (std::int64_t r = 0; r < stereo.rows; ++r)
    for (std::int64_t c = 0; c < stereo.columns; ++c) {
      const Eigen::Vector3d ray = image.ray(c, r);
      const double length = ray.norm();
      const auto hit = fan.cast(turn * (ray / length), &random);
      double depth = hit && hit->range <= stereo.max_range ? hit->range / length : 0;
      if (depth > 0 && !stereo.perfect) {
        const double by_disparity =
            stereo.baseline > 0 ? depth * depth * stereo.disparity_sd / (fine_focal * stereo.baseline) : 0;
        depth += random.normal(0, std::hypot(by_disparity, stereo.range_sd));
        if (random.bernoulli(stereo.dropouts)) depth = 0;
      }
      image.depths.push_back(depth > 0.1 ? static_cast<float>(depth) : 0.0F);
    }
  return image;
}

void describe_stereo(StereoModel& s, OptionVisitor& field) {
  field("on", s.on, {.help = "Simulate a depth camera"});
  field("every", s.every, {.help = "Seconds between two images", .min = 0.01, .max = 1e4});
  field("columns", s.columns, {.help = "Pixels across", .min = 2, .max = 4000});
  field("rows", s.rows, {.help = "Pixels down", .min = 2, .max = 4000});
  field("field", s.field, {.help = "Field of view across the columns", .min = 1, .max = 150});
  field("height", s.height, {.help = "Metres above the ground", .min = 0.1, .max = 50});
  field("tilt", s.tilt, {.help = "Tilt downwards", .min = -45, .max = 80});
  field("max_range", s.max_range,
        {.help = "Maximum range, metres", .min = 0.5, .max = 500, .formerly = "most_range"});
  field("baseline", s.baseline,
        {.help = "Metres between the cameras; 0: time of flight", .min = 0, .max = 10});
  field("disparity_sd", s.disparity_sd, {.help = "Pixels of an image of 1000 columns", .min = 0, .max = 10});
  field("range_sd", s.range_sd, {.help = "Range noise independent of range, metres", .min = 0, .max = 10});
  field("dropouts", s.dropouts, {.help = "Fraction of pixels without depth", .min = 0, .max = 1});
  field("perfect", s.perfect, {.help = "No noise and no dropouts"});
}

}  // namespace waymark::testbed
