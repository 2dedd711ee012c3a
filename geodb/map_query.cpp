// SPDX-License-Identifier: Apache-2.0
#include "geodb/map_query.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "core/error.hpp"
#include "geodb/layers/landmark_search.hpp"
#include "geodb/layers/largest_index.hpp"
#include "geodb/map_connection.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

using Tables = std::vector<LandmarkTable*>;

Tables tables_for(MapStore::Connection& map, const MapQuery& query) {
  Tables tables;
  if (query.types.empty())
    for (LandmarkTable& table : map.tables) tables.push_back(&table);
  for (const auto& type : query.types) tables.push_back(&map.table(type));
  return tables;
}

/// Throws Error{usage} for a name that no queried type has as a column of numbers: a typing error, not an
/// empty result.
void check_query_columns(const MapQuery& query, const Tables& tables) {
  const auto check = [&](const std::string& name) {
    if (name.empty()) return;
    std::set<std::string> known;
    for (const LandmarkTable* table : tables)
      for (const LandmarkColumn& column : table->layout.columns())
        if (number_column(table->layout, column.name)) known.insert(column.name);
    if (known.contains(name)) return;
    const std::string nearest = nearest_name(name, known);
    throw Error(ErrorCode::usage, "no landmark type asked for has a feature '" + name + "'", "",
                nearest.empty() ? "`waymark types` lists them" : "did you mean '" + nearest + "'?");
  };
  for (const auto& range : query.features) check(range.feature);
  check(query.largest_first);
}

/// Visits the rows with the largest values in their final order, by the index of write_map: equal values by
/// row, those without a value last. Returns whether they are all that the query can need; if not, `best` is
/// unusable.
bool visit_largest(const MapStore::Connection& map, const LandmarkTable& table, const MapQuery& query,
                   const LandmarkSearch& search, BestLandmarks& best) {
  if (query.sensor != nullptr && query.largest_first == "quality")
    return false;  // the sensor's is not stored
  std::size_t found = 0;
  const auto visit = [&](const std::string& rest) {
    sqlite::Statement row = map.database.prepare(table.layout.select(rest));
    while (found < best.limit() && row.step()) found += search.examine(row, best);
  };
  if (!number_column(table.layout, query.largest_first)) {  // of equal rank all
    visit("ORDER BY t.id");
    return true;
  }
  const LargestConditions largest =
      largest_conditions(map.database, table.layout.type().name, query.largest_first);
  if (largest.indexed.empty()) return false;
  visit("WHERE t." + largest.indexed + " ORDER BY t." + quote_identifier(query.largest_first) +
        " DESC, t.id");
  if (!largest.following.empty()) visit("WHERE t." + largest.following + " ORDER BY t.id");
  return largest.all_rows || found >= best.limit();
}

BestLandmarks search(MapStore::Connection& map, const Tables& tables, const MapQuery& query,
                     const SearchWindows& windows) {
  const bool whole = !query.near && !query.box, in_order = whole && query.largest_first.empty();
  BestLandmarks best(query.limit);
  for (LandmarkTable* table : tables) {
    if (in_order && best.full()) break;
    const LandmarkSearch one(map.crs, map.map_distance, query, table->layout);
    if (!one.has_queried_columns()) continue;
    if (whole && !query.largest_first.empty()) {
      BestLandmarks largest(query.limit);
      if (visit_largest(map, *table, query, one, largest)) {
        best.join(std::move(largest));
        continue;
      }
    }
    map.visit(*table, windows, [&](const sqlite::Statement& row) {
      one.examine(row, best);
      return !(in_order && best.full());
    });
  }
  return best;
}

/// Doubles the radius of the search until the circle contains k landmarks or the whole map.
std::vector<Landmark> nearest(MapStore::Connection& map, const Tables& tables, MapQuery query) {
  const auto [x, y, k] = *query.nearest;
  query.limit = std::min(query.limit, k);
  const Envelope& extent = map.extent;
  const auto reach = [&](double from_x, double from_y) {
    return map.map_distance(from_x, from_y, extent.max_x, extent.max_y);
  };
  const double across = extent.empty() ? 0 : reach(extent.min_x, extent.min_y);
  const double farthest = extent.empty() ? 0 : reach(x, y) + across;
  for (double radius = across / 1024; radius > 0 && radius < farthest; radius *= 2) {
    query.near = {x, y, Meters{radius}};
    BestLandmarks best = search(map, tables, query, search_windows(map.crs, *query.near));
    if (best.full()) return best.take();
  }
  query.near = {x, y, Meters{std::numeric_limits<double>::infinity()}};
  return search(map, tables, query, whole_plane()).take();
}

}  // namespace

std::optional<std::pair<double, double>> MapStore::range_of(const std::string& number,
                                                            const std::vector<std::string>& types) const {
  const MapQuery query{.types = types, .features = {{.feature = number}}};
  const Tables tables = tables_for(*connection_, query);
  check_query_columns(query, tables);
  std::optional<std::pair<double, double>> range;
  for (const LandmarkTable* table : tables) {
    if (!number_column(table->layout, number)) continue;
    const std::string column = quote_identifier(number);
    sqlite::Statement row =
        connection_->database.prepare("SELECT min(" + column + "), max(" + column + ") FROM " +
                                      quote_identifier(table->layout.type().name));
    if (!row.step()) continue;
    const std::optional<double> low = row.optional_real(0), high = row.optional_real(1);
    if (!low || !high) continue;
    range = range ? std::pair{std::min(range->first, *low), std::max(range->second, *high)}
                  : std::pair{*low, *high};
  }
  return range;
}

std::optional<MapQuery::Box> MapStore::extent() const {
  const Envelope& box = connection_->extent;
  if (box.empty()) return std::nullopt;
  return MapQuery::Box{box.min_x, box.min_y, box.max_x, box.max_y};
}

std::vector<Landmark> MapStore::query(const MapQuery& query) const {
  const Tables tables = tables_for(*connection_, query);
  check_query_columns(query, tables);
  if (query.nearest && (query.near || !query.largest_first.empty()))
    throw Error(ErrorCode::usage, "'nearest' cannot be combined with 'near' or an order", "",
                "ask for one of them");
  if (query.nearest) return nearest(*connection_, tables, query);
  SearchWindows windows = whole_plane();
  if (query.near)
    windows = search_windows(connection_->crs, *query.near);
  else if (query.box)
    windows = search_windows(connection_->crs, *query.box);
  return search(*connection_, tables, query, windows).take();
}

}  // namespace waymark::geodb
