// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "core/input_file.hpp"
#include "core/landmark.hpp"
#include "core/observation.hpp"
#include "core/units.hpp"
#include "geo/crs.hpp"
#include "geo/dem_handle.hpp"
#include "geodb/shape_layer.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark {

/// How a map came to be: enough to make it again.
struct RunRecord {
  std::string version;       ///< of Waymark
  std::string command_line;  ///< as a shell would take it
  std::string job_json;      ///< stages with all options, defaults filled in
  std::string started_utc;   ///< ISO 8601, "2026-11-21T07:21:14Z"; also the time stamp of every table
  std::string report_json;   ///< per stage: in, out, rejected by reason, seconds, warnings
  double seconds = 0;        ///< wall clock
  std::int64_t seed = 0;     ///< of all random generators
  std::vector<InputFile> inputs;
  friend bool operator==(const RunRecord&, const RunRecord&) = default;
};

/// An image landmarks were seen in.
struct ImageRecord {
  using Ring =
      std::vector<Eigen::Vector2d>;      ///< x, y in the map's CRS; closed or not, at least three corners
  std::string name;                      ///< unique in the map; Observation::source refers to it
  std::vector<Ring> footprint;           ///< ground it shows, one ring per part; empty: unknown
  std::string camera_json;               ///< camera model and pose
  std::string taken_utc;                 ///< ISO 8601; empty: unknown
  std::optional<Degrees> sun_azimuth;    ///< clockwise from map north
  std::optional<Degrees> sun_elevation;  ///< above the horizon
  std::optional<Meters> gsd;             ///< ground sample distance
  friend bool operator==(const ImageRecord&, const ImageRecord&) = default;
};

/// Landmarks in parts, each read when it is asked for, any number of times: of a map larger than memory.
struct LandmarkParts {
  std::size_t count = 0;
  std::function<std::shared_ptr<const std::vector<Landmark>>(std::size_t part)> landmarks = {};
  /// What the landmarks of that part rest on; none is rejected.
  std::function<std::shared_ptr<const std::vector<Observation>>(std::size_t part)> evidence = {};
};

/// All a map file holds, in memory but for the parts.
struct MapContents {
  TypeRegistry types;  ///< each gets a table; Landmark::type and Observation::type index it
  Crs crs = Crs::local();
  std::vector<Landmark> landmarks;
  std::vector<Observation> observations;
  LandmarkParts parts;  ///< besides; a landmark and all its evidence belong to one of them
  std::vector<ImageRecord> images;
  std::vector<ShapeLayer> layers;  ///< beside the landmarks: crowns, stands, tracks
  RunRecord run;
  DemHandle dem_coverage;  ///< stored in the map as elevation tiles; null: none
};

}  // namespace waymark
