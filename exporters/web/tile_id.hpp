// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
namespace waymark::exporters {

/// Square of the world at a zoom: 2^zoom tiles per side, column 0 in the west, row 0 in the north.
struct TileId {
  int zoom = 0;
  std::uint32_t column = 0, row = 0;
  friend bool operator==(const TileId&, const TileId&) = default;
};

/// Returns the index of a cell on the Hilbert curve that fills the grid of 2^zoom cells per side, zoom in
/// [0, 31]. The index at the next coarser zoom is this one divided by 4.
std::uint64_t hilbert_of(const TileId& cell);

/// Returns the number of a tile in a PMTiles archive: the tiles of all coarser zooms come first.
std::uint64_t pmtiles_id(const TileId& tile);

}  // namespace waymark::exporters
