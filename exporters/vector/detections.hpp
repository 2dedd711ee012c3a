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
namespace waymark::exporters {

/// Detections in one image, with the scale and orientation of its pixels on the ground.
struct ImageDetections {
  TypeId type = 0;
  std::string image;                         ///< name: file name without folders
  std::int64_t columns = 0, rows = 0;        ///< of the image
  std::vector<Detection> detections;         ///< in the order of output
  std::optional<Georeference> georeference;  ///< of an orthophoto: pixel -> map, projected or local CRS
  std::optional<Meters> gsd;                 ///< of an image without georeference
  std::optional<Degrees> sun_elevation;      ///< needed for heights
  std::optional<Degrees> sun_azimuth;        ///< for the record, clockwise from map north
  std::optional<Radians> sun_angle =
      {};  ///< of the search, from x towards y; with oblong pixels heights need it
  std::vector<FeatureSet> features = {};  ///< of each detection, if the detector measures them; empty:
                                          ///< derived from the outlines by level_ground_features
};

/// Computes the features of the type on level ground, in the order of the type, each with the variance of its
/// measurement:
/// - radius, major_axis, minor_axis;
/// - orientation (clockwise from map north; from the image's upper edge without georeference);
/// - height = shadow_reach x tan(sun elevation) along the shadow.
/// Unknown features are absent, and all of them if the size of a pixel is unknown.
FeatureSet level_ground_features(const ImageDetections& found, const Detection& one,
                                 const LandmarkType& type);

/// Returns the features of detection number `index`: the detector's own, or level_ground_features.
FeatureSet features_of(const ImageDetections& found, std::size_t index, const LandmarkType& type);

/// Returns the column of a feature: its name, prefixed by the type if a pixel column has that name
/// (tree_diameter).
std::string feature_column(const LandmarkType& type, const FeatureSpec& feature);

/// Returns CSV with the columns of docs/reference/detection_table.md: pixels, then the type's features if the
/// size of a pixel is known, then map_x, map_y in the image's CRS if it is georeferenced. Numbers have six
/// significant digits, positions four decimals of a pixel or of a metre.
std::string detections_to_csv(const ImageDetections& found, const LandmarkType& type);

/// Returns a GeoJSON collection of points with the same properties. A georeferenced image on Earth gives
/// longitude and latitude (RFC 7946); on another body positions in its geographic CRS, named by a `crs`
/// member; an image without georeference gives pixels in a local CRS.
std::string detections_to_geojson(const ImageDetections& found, const LandmarkType& type);

/// Returns a map: every detection is a landmark with one observation, the image has its outline. An image
/// without georeference lies on a local plane in metres, x right, y up, its pixel (0, 0) at the origin; a
/// pixel of unknown size counts as a metre. Run, types and DEM are left to the caller.
geodb::MapContents detections_to_map(const ImageDetections& found, const TypeRegistry& types);

}  // namespace waymark::exporters
