// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <vector>
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Request of a raster of what the landmarks of a map give a localizer.
struct ObservabilityRequest {
  std::string map;
  std::string output;                                      ///< .tif; a style .qml is written beside it
  std::string sensor;                                      ///< name or file (.json) of a sensor profile
  double range = 0, view = 0;                              ///< metres, degrees; 0: those of the sensor
  double cell = std::numeric_limits<double>::quiet_NaN();  ///< metres; NaN: 2, or wider for a million cells
  double drive = 100;                                      ///< metres driven at each place
  std::vector<std::string> dem = {};  ///< terrain that hides landmarks; empty: stored in the map, or none
  double sensor_height = 1;           ///< metres above the terrain
  std::string aoi = {};               ///< polygons: cells outside have no value; empty: all
  std::int64_t tile_cells = 256;
  int threads = 0;
};

struct ObservabilityResult {
  std::int64_t columns = 0, rows = 0;
  double cell = 0;       ///< metres
  double seen = 0;       ///< fraction of the cells with a landmark in sight
  double median_sd = 0;  ///< of these cells, metres, to 5 %
};

/// Writes the raster of all terrain from which a landmark can be seen, by tiles. The bytes do not depend on
/// tiles and threads. Throws Error{usage} for a sensor without range and too many cells, Error{input} for a
/// map in degrees or without landmarks.
ObservabilityResult make_observability(const ObservabilityRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
