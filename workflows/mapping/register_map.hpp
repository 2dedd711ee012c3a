// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include "geo/crs.hpp"
#include "localization/registration/register_circles.hpp"
#include "workflows/callbacks.hpp"
#include "workflows/mapping/move_map.hpp"
namespace waymark::workflows {

/// A map, and what places it.
struct RegisterRequest {
  std::string map = {};        ///< in metres: a projected or local CRS
  std::string catalogue = {};  ///< DEM; or craters in a GeoPackage, CSV or any layer: positions and diameters
  std::string result = {};     ///< map to write
  std::string dem = {};        ///< heights of the map; empty: its elevation tiles
  std::string columns = {};    ///< of the catalogue, as for an import
  std::string crs = {};        ///< of the new map; empty: the map's, else that of catalogue or DEM
  localization::CircleRules rules = {};
  std::string command_line = {};  ///< recorded in the new map
};

/// Place of a map in known coordinates.
struct MapPlace {
  MapMove move = {};
  Crs crs = Crs::local();
  std::string text = {};       ///< parameters with standard deviations, for people
  std::int64_t compared = 0;   ///< craters or cells
  std::int64_t agreed = 0;     ///< those of them that match
  std::string disagreed = {};  ///< why the others do not
  double residual = 0;         ///< m, root mean square: positions of craters, or heights
};

/// Registers a map by its craters, or by its heights if the catalogue is a raster. Writes it with everything
/// moved, and with all runs. Throws Error{usage} for a request in conflict, Error{input} for a place that is
/// not certain, Error{output} before any work is done for a map that cannot be written. Messages: the
/// similarity with standard deviations, what is left out.
MapPlace register_map(const RegisterRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
