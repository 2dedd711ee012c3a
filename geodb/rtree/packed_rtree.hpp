// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>
#include "geodb/sqlite/sqlite.hpp"
namespace waymark::geodb {

/// Box of a row in a spatial index.
struct IndexedBox {
  std::int64_t id = 0;
  double min_x = 0, max_x = 0, min_y = 0, max_y = 0;
};

/// Bulk-loads the empty RTree "rtree_<table>_geom" by writing its _node, _parent and _rowid tables.
/// - It is about ten times faster than inserts, and nodes are full.
/// - Consecutive boxes share a node: give them in Hilbert order.
/// - Boxes are float32, rounded outwards.
/// - The format is that of SQLite's ext/rtree/rtree.c; `rtreecheck` accepts it, and later inserts work.
void fill_rtree(const sqlite::Database& database, std::string_view table, std::span<const IndexedBox> boxes);
/// Bulk-loads the RTree with the geometries of the table in the order of its rows. They are read one by one;
/// memory is half a byte per row.
void fill_rtree(const sqlite::Database& database, std::string_view table);

/// Returns the boxes of the geometries of a table in the order of its rows.
std::vector<IndexedBox> boxes_of(const sqlite::Database& database, std::string_view table);
/// Returns true if the leaves of the RTree list the rows in their order, as fill_rtree() by the rows makes
/// them.
bool has_row_order(const sqlite::Database& database, std::string_view table);

}  // namespace waymark::geodb
