// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/place_names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <optional>

#include "core/bytes.hpp"
#include "core/error.hpp"
#include "core/lower_case.hpp"
#include "importers/tables/table.hpp"
#include "importers/tables/table_number.hpp"
#include "importers/tables/table_positions.hpp"

namespace waymark::importers {
namespace {

std::optional<std::size_t> column_of(const TableHeader& table, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      if (lower_case(table.columns[i]) == name) return i;
  return {};
}

std::size_t needed_column(const TableHeader& table, const std::vector<std::string>& names,
                          const std::string& hint) {
  if (const auto found = column_of(table, names)) return *found;
  throw Error(ErrorCode::input, fmt::format("the table of names has no column '{}'", names[0]), table.path,
              fmt::format("{}; it has: {}", hint, fmt::join(table.columns, ", ")));
}

}  // namespace

std::vector<PlaceName> read_place_names(const std::string& path, const std::string& layer,
                                        const std::string& column, const Crs& into) {
  const auto table = open_table(path, TableFormat::by_name, layer, "");
  const TableHeader& header = table->header();
  const std::size_t name = column.empty()
                               ? needed_column(header, {"name", "label", "toponym"}, "name it in name_column")
                               : needed_column(header, {lower_case(column)}, "check the name");
  const std::size_t x =
      needed_column(header, {"geom_x", "x", "lon", "longitude", "easting"}, "points have x and y");
  const std::size_t y =
      needed_column(header, {"geom_y", "y", "lat", "latitude", "northing"}, "points have x and y");
  const bool degrees = lower_case(header.columns[x]).starts_with("lon");
  TablePositions positions(header, "", into.kind() == CrsKind::local ? "local" : into.wkt2(), degrees);
  std::vector<PlaceName> places;
  TableRow row;
  while (table->next(row)) {
    const auto number = [&](std::size_t cell) {
      return to_real(row.cells[cell], header.decimal_comma).value_or(std::nan(""));
    };
    Point<MapCrs> at{{number(x), number(y), 0}};
    if (row.cells[name].empty() || !positions.transform_to_map(at).empty()) continue;
    places.push_back({row.cells[name], at.xyz.x(), at.xyz.y()});
  }
  return places;
}

std::string encode_place_names(const PlaceNames& names) {
  ByteWriter write;
  write(names.max_distance);
  write(static_cast<std::uint64_t>(names.places.size()));
  for (const PlaceName& place : names.places) write(place.name), write(place.x), write(place.y);
  return write.take();
}

PlaceNames decode_place_names(std::string_view bytes) {
  ByteReader read(bytes);
  PlaceNames names;
  read(names.max_distance);
  names.places.resize(read.length(3 * sizeof(double)));
  for (PlaceName& place : names.places) read(place.name), read(place.x), read(place.y);
  read.expect_end();
  return names;
}

}  // namespace waymark::importers
