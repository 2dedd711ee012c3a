// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Request of a folder that shows a map in web browsers.
struct WebMapRequest {
  std::string map;
  std::string aoi = {};                 ///< polygons: landmarks outside are left out; empty: none are
  std::string output;                   ///< folder; an older web map in it is replaced
  std::vector<std::string> types = {};  ///< landmark types shown; empty: all
  double min_confidence = 0;            ///< landmarks of less are left out
  std::vector<std::string> dem = {};    ///< elevation models; empty: stored in the map, or read by its runs
  std::int64_t terrain_pixels = 4096;   ///< of the longer side of the terrain, at most; 0: no terrain
  int max_zoom = -1;                    ///< zoom that shows all landmarks; -1: chosen by their density
  std::string assets = {};              ///< folder of the map library; empty: fetched later
  std::string title = {};               ///< empty: the map's name
  int threads = 0;
};

struct WebMapResult {
  std::int64_t landmarks = 0, outside = 0;  ///< shown; beyond the edges of web maps
  int max_zoom = 0;
  std::int64_t landmark_tiles = 0, terrain_tiles = 0;
  std::int64_t shapes = 0, shape_tiles = 0;  ///< polygons of stands and crowns
  bool has_library = false;                  ///< the folder holds the map library
};

/// Writes the folder. Its bytes do not depend on threads. Memory: about 300 bytes per landmark, 16
/// per vertex of a stand or crown, and 6 per pixel of the terrain. Throws Error{input} for a map without
/// landmarks and a DEM that cannot be read, Error{usage} for an unknown type and a library of another
/// version, Error{output} for a folder with other files, or if the disk is full: an older web map is
/// unchanged then.
WebMapResult make_web_map(const WebMapRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
