// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <vector>
#include "planning/hazard_map.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Request of a hazard map.
struct HazardMapRequest {
  std::string input;             ///< map (.gpkg), or a DEM without objects
  std::vector<std::string> dem;  ///< DEM of a map; empty: stored in the map
  std::string output;            ///< .tif; a style .qml is written beside it
  std::string vehicle = "rover";
  std::string polygons;  ///< GeoPackage for the layer `hazard`; empty: none
  std::string nav2;      ///< map.yaml; empty: none
  double height_sd = std::numeric_limits<double>::quiet_NaN();   ///< metres; NaN: that of the DEM
  double height_correlation = 0;                                 ///< metres
  double rock_cover = std::numeric_limits<double>::quiet_NaN();  ///< k of the site; NaN: fitted to its rocks
  double detection_limit = std::numeric_limits<double>::quiet_NaN();  ///< metres; NaN: fitted to its rocks
  double min_uncertain = 0.05, min_hazard = 0.5;                      ///< probabilities
  std::string landing_ellipse;  ///< MAJOR,MINOR[,AZIMUTH] for the band `landing`; empty: none
  std::string sun;  ///< AZIMUTH,ELEVATION in degrees for the bands `horizon`, `shade`; empty: none
  double horizon_reach = 1000;  ///< metres
  std::string aoi;              ///< polygons: terrain outside is unknown; empty: all
  std::string crs;              ///< of a DEM whose file has none
  std::int64_t tile_cells = 512;
  int threads = 0;
  std::string command_line;
};

/// What a hazard map found.
struct HazardMapResult {
  planning::ClassCounts cells = {};
  std::int64_t objects = 0;  ///< landmarks that may be hazards
  planning::UndetectedRocks undetected;
  planning::Uncertain undetected_per_metre;  ///< expected hazardous undetected rocks per metre driven
};

/// Returns the names of the classes of cells: safe, uncertain, hazard, unknown.
std::vector<std::string> hazard_class_names();

/// Writes a hazard map by tiles; memory does not depend on its size. The bytes do not depend on tiles and
/// threads. Throws Error{usage} or Error{input} for a DEM in degrees, a map without heights or with all its
/// landmarks off the DEM, a bad vehicle.
HazardMapResult make_hazard_map(const HazardMapRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
