// SPDX-License-Identifier: Apache-2.0
#include "geodb/map_query.hpp"

#include <algorithm>
#include <set>

#include "core/error.hpp"
#include "geodb/landmark_search.hpp"
#include "geodb/map_connection.hpp"

namespace waymark {
namespace {

using Tables = std::vector<LandmarkTable*>;

Tables tables_for(MapStore::Connection& map, const MapQuery& query) {
  Tables tables;
  if (query.types.empty())
    for (LandmarkTable& table : map.tables) tables.push_back(&table);
  for (const auto& type : query.types) tables.push_back(&map.table(type));
  return tables;
}

/// A feature no type has is a slip of the pen, not an empty answer.
void check_features(const MapQuery& query, const Tables& tables) {
  std::set<std::string> known = {"quality"};
  for (const LandmarkTable* table : tables)
    for (const auto& feature : table->layout.type().features) known.insert(feature.name);
  const auto check = [&](const std::string& feature) {
    if (feature.empty() || known.contains(feature)) return;
    const std::string nearest = nearest_name(feature, known);
    throw Error(ErrorCode::usage, "no landmark type asked for has a feature '" + feature + "'", "",
                nearest.empty() ? "`waymark types` lists them" : "did you mean '" + nearest + "'?");
  };
  for (const auto& range : query.features) check(range.feature);
  check(query.largest_first);
}

BestLandmarks search(MapStore::Connection& map, const Tables& tables, const MapQuery& query,
                     const SearchWindows& windows) {
  BestLandmarks best(query.limit);
  for (LandmarkTable* table : tables) {
    const LandmarkSearch one(map.crs, map.ruler, query, table->layout.type());
    if (!one.possible()) continue;
    map.visit(*table, windows, [&](const sqlite::Statement& row) { one.look_at(table->layout, row, best); });
  }
  return best;
}

/// Circles about the place, each twice as wide, until one holds k landmarks; the last holds everything.
std::vector<Landmark> nearest(MapStore::Connection& map, const Tables& tables, MapQuery query) {
  const auto [x, y, k] = *query.nearest;
  query.limit = std::min(query.limit, k);
  const Envelope& extent = map.extent;
  const auto reach = [&](double from_x, double from_y) {
    return map.ruler(from_x, from_y, extent.max_x, extent.max_y);
  };
  const double across = extent.empty() ? 0 : reach(extent.min_x, extent.min_y);
  const double farthest = extent.empty() ? 0 : reach(x, y) + across;
  for (double radius = across / 1024; radius > 0 && radius < farthest; radius *= 2) {
    query.near = {x, y, Meters{radius}};
    BestLandmarks best = search(map, tables, query, windows_of(map.crs, *query.near));
    if (best.full()) return best.take();
  }
  query.near = {x, y, Meters{std::numeric_limits<double>::infinity()}};
  return search(map, tables, query, everywhere()).take();
}

}  // namespace

std::vector<Landmark> MapStore::query(const MapQuery& query) const {
  const Tables tables = tables_for(*connection_, query);
  check_features(query, tables);
  if (query.nearest && (query.near || !query.largest_first.empty()))
    throw Error(ErrorCode::usage, "'nearest' cannot be combined with 'near' or an order", "",
                "ask for one of them");
  if (query.nearest) return nearest(*connection_, tables, query);
  SearchWindows windows = everywhere();
  if (query.near)
    windows = windows_of(connection_->crs, *query.near);
  else if (query.box)
    windows = windows_of(connection_->crs, *query.box);
  return search(*connection_, tables, query, windows).take();
}

}  // namespace waymark
