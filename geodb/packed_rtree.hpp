// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include "geodb/sqlite.hpp"
namespace waymark {

struct IndexedBox {
  std::int64_t id = 0;
  double min_x = 0, max_x = 0, min_y = 0, max_y = 0;
};

/// Fills the empty RTree "rtree_<table>_geom" from below, by writing its _node, _parent and _rowid tables:
/// about ten times faster than inserting, and nodes are full. Boxes that follow each other share a node, so
/// they should come in Hilbert order. Boxes are float32, rounded outwards. The format is that of SQLite's
/// ext/rtree/rtree.c; `rtreecheck` accepts the result, and inserts go on from there.
void fill_rtree(const sqlite::Database& database, std::string_view table, std::span<const IndexedBox> boxes);
/// The same with the geometries of the table, in the order of its rows: they are read back one by one, so
/// memory is that of the inner nodes, half a byte per row.
void fill_rtree(const sqlite::Database& database, std::string_view table);

}  // namespace waymark
