// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/tile.hpp"

#include <nlohmann/json.hpp>

#include "core/json_text.hpp"

namespace waymark::pipeline {

Window expand(const Window& window, std::int64_t halo) {
  return {.column = window.column - halo,
          .row = window.row - halo,
          .columns = window.columns + 2 * halo,
          .rows = window.rows + 2 * halo};
}

// One row of numbers per tile: index, column, row, window, rank if it is not 0.
std::string Codec<std::vector<Tile>>::encode(const std::vector<Tile>& tiles) {
  auto rows = nlohmann::json::array();
  for (const auto& [index, column, row, cells, rank] : tiles) {
    rows.push_back({index, column, row, cells.column, cells.row, cells.columns, cells.rows});
    if (rank != 0) rows.back().push_back(rank);
  }
  return rows.dump();
}

std::vector<Tile> Codec<std::vector<Tile>>::decode(std::string_view bytes) {
  std::vector<Tile> tiles;
  for (const auto& row : nlohmann::json::parse(checked_json(bytes, "tiles"))) {
    const auto n = row.get<std::vector<std::int64_t>>();
    tiles.push_back(
        {n.at(0), n.at(1), n.at(2), {n.at(3), n.at(4), n.at(5), n.at(6)}, n.size() > 7 ? n[7] : 0});
  }
  return tiles;
}

}  // namespace waymark::pipeline
