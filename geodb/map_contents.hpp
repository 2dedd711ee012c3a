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
namespace waymark::geodb {

/// Provenance of a map, sufficient to reproduce it.
struct RunRecord {
  std::string version;       ///< of Waymark
  std::string command_line;  ///< in shell syntax
  std::string job_json;      ///< stages with all options, defaults filled in
  std::string started_utc;   ///< ISO 8601, "2026-11-21T07:21:14Z"; also the time stamp of every table
  std::string report_json;   ///< per stage: in, out, rejected by reason, seconds, warnings
  double seconds = 0;        ///< wall clock
  std::int64_t seed = 0;     ///< of all random generators
  std::vector<InputFile> inputs;
  friend bool operator==(const RunRecord&, const RunRecord&) = default;
};

/// Image in which landmarks were observed.
struct ImageRecord {
  /// Vertices x, y in the map's CRS; closed or not, at least three.
  using Ring = std::vector<Eigen::Vector2d>;
  std::string name;                      ///< unique in the map; Observation::source refers to it
  std::vector<Ring> footprint;           ///< footprint on the ground, one ring per part; empty: unknown
  std::string camera_json;               ///< camera model and pose
  std::string taken_utc;                 ///< ISO 8601; empty: unknown
  std::optional<Degrees> sun_azimuth;    ///< clockwise from map north
  std::optional<Degrees> sun_elevation;  ///< above the horizon
  std::optional<Meters> gsd;             ///< ground sample distance
  friend bool operator==(const ImageRecord&, const ImageRecord&) = default;
};

/// Landmarks of a map larger than memory, in parts that are read on demand, any number of times.
struct LandmarkParts {
  std::size_t count = 0;
  std::function<std::shared_ptr<const std::vector<Landmark>>(std::size_t part)> landmarks = {};
  /// Observations of the landmarks of that part, none rejected; null: none.
  std::function<std::shared_ptr<const std::vector<Observation>>(std::size_t part)> evidence = {};
  /// Rejected observations, divided into the same number of parts; null: none.
  std::function<std::shared_ptr<const std::vector<Observation>>(std::size_t part)> rejected = {};
};

/// Contents of a map file, in memory except for the parts.
struct MapContents {
  TypeRegistry types;  ///< each gets a table; Landmark::type and Observation::type index it
  Crs crs = Crs::local();
  std::vector<Landmark> landmarks;
  std::vector<Observation> observations;
  LandmarkParts parts;  ///< additional landmarks; a landmark and its observations belong to one part
  std::vector<ImageRecord> images;
  std::vector<ShapeLayer> layers;  ///< additional layers: crowns, stands, tracks
  RunRecord run;
  std::vector<RunRecord> earlier_runs = {};  ///< oldest first
  DemHandle dem_coverage;                    ///< stored in the map as elevation tiles; null: none
};

}  // namespace waymark::geodb
