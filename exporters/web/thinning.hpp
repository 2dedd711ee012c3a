// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "exporters/web/tile_id.hpp"
#include "exporters/web/web_landmarks.hpp"
namespace waymark::exporters {

/// Landmark that a zoom shows.
struct ShownLandmark {
  std::size_t landmark = 0;  ///< index
  std::int64_t hidden = 0;   ///< landmarks of its layer in its cell that the zoom does not show
};

/// Largest number of landmarks in a tile that shows all of them.
inline constexpr std::size_t kMaxPerTile = 1000;

/// Returns the landmarks that a zoom below the top shows, in the order of the curve: all of tiles that have
/// at most kMaxPerTile; of others the foremost of each layer in each cell. What a zoom shows is shown by all
/// finer ones, since their tiles and cells divide these. Shown and hidden ones add up to all landmarks.
std::vector<ShownLandmark> thin_out(std::span<const WebLandmark> landmarks, int zoom);

/// Returns all landmarks, none hidden.
std::vector<ShownLandmark> all_of(std::span<const WebLandmark> landmarks);

/// Returns the coarsest zoom at which tiles have at most kMaxPerTile landmarks and steps are small;
/// kMaxWebZoom if none is. A step of a tile is at most a millimetre or 1e-5 of the width of the map.
/// `world_width`: metres.
int top_zoom(std::span<const WebLandmark> landmarks, double world_width);

/// Tile, and the landmarks in it as a range of a list of shown ones.
struct LandmarkTile {
  TileId id;
  std::size_t first = 0, count = 0;
};

/// Divides the shown landmarks into the tiles of a zoom, ascending by pmtiles_id.
std::vector<LandmarkTile> tiles_of(std::span<const WebLandmark> landmarks,
                                   std::span<const ShownLandmark> shown, int zoom);

/// Returns the gzipped vector tile of shown landmarks; a layer is named after its type.
std::string landmark_tile(const WebLandmarks& all, std::span<const ShownLandmark> shown, int zoom);

}  // namespace waymark::exporters
