// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "localization/craters/crater_index.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Detected craters of images, and the map of a body to find the images in.
struct LocateRequest {
  std::string map;
  std::vector<std::string> detections;  ///< tables with x, y and diameter or radius, pixels, one per image
  std::string output = {};              ///< .csv with a row per image; empty: none
  std::string matches = {};             ///< .csv with the crater of each detection; empty: none
  std::vector<double> size = {};      ///< width and height of the images, pixels; empty: from the detections
  double focal = 0;                   ///< pixels; 0: images are orthophotos
  double altitude = 0;                ///< metres above the surface, to 15 %; 0: unknown; needs `focal`
  std::vector<double> scale = {};     ///< least and largest metres per pixel; empty: unknown
  double min_confidence = 0;          ///< of craters of the map that are searched
  std::vector<std::string> set = {};  ///< OPTION=VALUE, settings of the search
};

/// Where an image was taken.
struct LocatedImage {
  std::string detections;  ///< file
  bool located = false;
  std::string reason = {};  ///< why it is not located
  double wrong_probability = 1;
  std::int64_t detected = 0, matched = 0;
  double residual_px = 0;
  LonLat middle = {};  ///< of the image, on the surface
  double metres_per_pixel = 0;
  double azimuth = 0;                              ///< rad clockwise from north, of the upward direction
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();  ///< rad, about image x and y
  LonLat camera = {};                              ///< below the camera; needs `focal`
  double altitude = 0;                             ///< m, of the camera; 0: unknown
  /// Of east and north of the middle (m), ln of metres per pixel, azimuth, and tilts (rad).
  localization::ImagePose::Covariance covariance = localization::ImagePose::Covariance::Zero();
};

struct LocateResult {
  std::vector<LocatedImage> images;  ///< in the order of the request
  std::int64_t map_craters = 0;
};

/// Finds where images of craters were taken, from the positions and radii of the craters alone. Throws
/// Error{input} for a map without craters or in a local CRS, and a table without the columns, Error{usage}
/// for values that contradict each other. Messages: a line per image.
LocateResult locate_images(const LocateRequest& request, const Callbacks& callbacks = {});

/// Returns every setting of the search with its value and effect, a line each.
std::string locate_settings(const LocateRequest& request);

}  // namespace waymark::workflows
