// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <span>

#include "geodb/checks/map_checks.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

constexpr const char* kTriggers[] = {"insert", "update1", "update2", "update3", "update4", "delete"};

// Boxes are float32, rounded outwards: they may differ by 2^-22 of the coordinate.
constexpr const char* kMissing =
    R"(SELECT t.id, 'the row is not in the spatial index' FROM "{t}" t LEFT JOIN "rtree_{t}_geom" r ON r.id = t.id
       WHERE r.id IS NULL AND t.geom NOT NULL AND NOT ST_IsEmpty(t.geom))";
constexpr const char* kOrphan =
    R"(SELECT r.id, 'the spatial index has a box of a missing row' FROM "rtree_{t}_geom" r
       WHERE r.id NOT IN (SELECT id FROM "{t}"))";
constexpr const char* kWrong =
    R"(SELECT t.id, 'the box in the spatial index differs from that of the geometry' FROM "{t}" t JOIN "rtree_{t}_geom" r ON r.id = t.id
       WHERE ST_MinX(t.geom) < r.minx OR ST_MaxX(t.geom) > r.maxx OR ST_MinY(t.geom) < r.miny OR ST_MaxY(t.geom) > r.maxy
          OR r.maxx - r.minx > ST_MaxX(t.geom) - ST_MinX(t.geom) + 1e-6 * abs(r.maxx)
          OR r.maxy - r.miny > ST_MaxY(t.geom) - ST_MinY(t.geom) + 1e-6 * abs(r.maxy))";
constexpr const char* kOutside =
    R"(SELECT t.id, 'the row lies outside the extent of its layer' FROM "{t}" t, gpkg_contents c
       WHERE c.table_name = '{t}' AND (c.min_x IS NULL OR ST_MinX(t.geom) < c.min_x OR ST_MaxX(t.geom) > c.max_x
          OR ST_MinY(t.geom) < c.min_y OR ST_MaxY(t.geom) > c.max_y))";

void check_triggers(const sqlite::Database& database, const std::string& table, const std::string& prefix,
                    std::span<const char* const> names, const char* code, FindingList& findings) {
  sqlite::Statement known =
      database.prepare("SELECT 1 FROM sqlite_master WHERE type = 'trigger' AND name = ?");
  for (const char* trigger : names) {
    const std::string name = prefix + "_" + trigger;
    known.bind(1, name);
    if (!known.step()) findings.add(code, table, std::nullopt, "trigger " + name + " is missing");
    known.reset();
  }
}

}  // namespace

void check_edit_triggers(const sqlite::Database& database, const std::string& table, FindingList& findings) {
  constexpr const char* kEdits[] = {"added", "moved", "removed"};  // edits.sql
  check_triggers(database, table, table, kEdits, "edits.trigger", findings);
}

void check_spatial_index(const sqlite::Database& database, const std::string& table, FindingList& findings) {
  const std::string index = "rtree_" + table + "_geom";
  if (!database.has_table(index))
    return findings.add("rtree.missing", table, std::nullopt, "the table has no spatial index");
  check_triggers(database, table, index, kTriggers, "rtree.trigger", findings);
  sqlite::Statement sound = database.prepare("SELECT rtreecheck(?)");
  sound.bind(1, index);
  if (sound.step() && sound.text(0) != "ok")
    return findings.add("rtree.damaged", table, std::nullopt, std::string(sound.text(0)));
  sound.reset();
  for (const auto& [code, sql] : {std::pair("rtree.row", kMissing), std::pair("rtree.orphan", kOrphan),
                                  std::pair("rtree.box", kWrong), std::pair("layer.extent", kOutside)})
    find_rows(database, findings, code, table, substitute_keys(sql, {{"t", table}}));
}

}  // namespace waymark::geodb
