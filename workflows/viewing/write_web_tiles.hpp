// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "exporters/web/pmtiles_file.hpp"
#include "exporters/web/terrain_tiles.hpp"
#include "exporters/web/web_shapes.hpp"
#include "exporters/web/web_style.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Threads and progress of the writing of tiles. `threads` 0: as many as there are cores.
struct TileWriting {
  int threads = 0;
  const Callbacks& callbacks;
};

/// Writes all tiles of an archive, made on all threads and added in order. Returns their number. Throws
/// Error{output}.
std::int64_t write_landmark_tiles(const TileWriting& writing, exporters::PmtilesFile& file,
                                  const exporters::WebLandmarks& all, const exporters::WebStyle& style,
                                  int max_zoom);
std::int64_t write_shape_tiles(const TileWriting& writing, exporters::PmtilesFile& file,
                               const exporters::WebShapes& all, const std::string& title, int top);
std::int64_t write_terrain_tiles(const TileWriting& writing, exporters::PmtilesFile& file,
                                 const exporters::TerrainTiles& terrain, const Crs& crs,
                                 exporters::WebPlane plane);

}  // namespace waymark::workflows
