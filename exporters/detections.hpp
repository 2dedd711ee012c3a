// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "core/detection.hpp"
#include "core/units.hpp"
#include "geo/georeference.hpp"
#include "geodb/map_contents.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark {

/// What was found in one image, and what is known of its pixels on the ground.
struct ImageDetections {
  TypeId type = 0;
  std::string image;                      ///< name: file name without folders
  std::int64_t columns = 0, rows = 0;     ///< of the image
  std::vector<Detection> detections;      ///< in the order they are written
  std::optional<Georeference> place;      ///< of an orthophoto: pixel -> map, projected or local CRS
  std::optional<Meters> gsd;              ///< of an image without place
  std::optional<Degrees> sun_elevation;   ///< needed for heights
  std::optional<Degrees> sun_azimuth;     ///< for the record, clockwise from map north
  std::vector<FeatureSet> features = {};  ///< of each detection, where the detector measures them itself;
                                          ///< empty: from the outlines, by features_on_ground
};

/// Features of the type on level ground, in the order of the type: radius, major_axis, minor_axis,
/// orientation (clockwise from map north; from the image's upper edge where it is not placed), height =
/// shadow_reach x tan(sun elevation) along the shadow, each with the variance of its measurement. Unknown
/// features, and all of them where the size of a pixel is not known, are absent.
FeatureSet features_on_ground(const ImageDetections& found, const Detection& one, const LandmarkType& type);

/// Features of detection number `index`: the detector's own, or features_on_ground.
FeatureSet features_of(const ImageDetections& found, std::size_t index, const LandmarkType& type);

/// The column of a feature: its name, or with the type before it where a column of pixels has that name
/// (tree_diameter).
std::string feature_column(const LandmarkType& type, const FeatureSpec& feature);

/// CSV with the columns of docs/detect.md: pixels, then the type's features where the size of a pixel is
/// known, then map_x, map_y in the image's CRS where it is placed. Numbers have six significant digits,
/// positions four decimals of a pixel or of a metre.
std::string detections_as_csv(const ImageDetections& found, const LandmarkType& type);

/// A GeoJSON collection of points with the same properties. A placed image on Earth gives longitude and
/// latitude (RFC 7946); on another body positions in its geographic CRS, named by a `crs` member; an image
/// that is not placed gives pixels, with a local one.
std::string detections_as_geojson(const ImageDetections& found, const LandmarkType& type);

/// A map: every detection is a landmark with one observation, the image has its outline. An image that is not
/// placed is laid on a local plane in metres, x right, y up, its pixel (0, 0) at the origin; where the size
/// of its pixels is unknown too, a pixel counts as a metre. Run, types and DEM are left to the caller.
MapContents detections_as_map(const ImageDetections& found, const TypeRegistry& types);

}  // namespace waymark
