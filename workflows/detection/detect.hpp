// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>
#include "exporters/vector/detections.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// One image and what to look for in it. Numbers that are not given are NaN.
struct DetectRequest {
  std::string kind;    ///< name of a detector: "craters"; image_detectors() has all
  std::string image;   ///< any path that GDAL opens
  std::string output;  ///< .csv, .geojson, .json or .gpkg; empty: no file is written
  std::string method;  ///< of the detector; empty: its first one, or chosen by the image
  std::string crs;     ///< of a georeferenced image that names none or a wrong one
  std::map<std::string, std::string> settings =
      {};                ///< of the detector itself, as text by name; empty texts are defaults
  std::string aoi = {};  ///< polygons: detections outside are dropped; georeferenced images only; empty: none
  double sun_azimuth = std::numeric_limits<double>::quiet_NaN();    ///< degrees clockwise from map north
  double sun_elevation = std::numeric_limits<double>::quiet_NaN();  ///< degrees above the horizon
  double image_sun_angle =
      std::numeric_limits<double>::quiet_NaN();                      ///< degrees from x towards y, to the sun
  double gsd = std::numeric_limits<double>::quiet_NaN();             ///< metres per pixel
  double min_diameter = std::numeric_limits<double>::quiet_NaN();    ///< pixels
  double max_diameter = std::numeric_limits<double>::quiet_NaN();    ///< pixels
  double min_confidence = std::numeric_limits<double>::quiet_NaN();  ///< 0 to 1
  std::int64_t band = 0;          ///< from 1; 0: brightness of a colour image, else the first
  std::int64_t piece = 8192;      ///< side of the pieces of a large image, pixels
  int threads = 0;                ///< 0: one per processor
  std::string command_line = {};  ///< recorded in a map
};

/// Detections in an image.
struct DetectResult {
  exporters::ImageDetections detections;
  std::int64_t outside = 0;  ///< detections dropped because they lie outside the area of interest
  std::string light;         ///< estimated direction of the light, for people; empty: it was given
  std::vector<std::string> warnings;
};

/// Finds the objects of one kind in one image and writes them to the output. An image without contrast or
/// data has no detections and a warning that says why. Throws Error{usage} for options out of range or in
/// conflict, Error{input} for a missing or damaged image, Error{output} before any work is done.
DetectResult detect(const DetectRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
