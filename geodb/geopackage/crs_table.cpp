// SPDX-License-Identifier: Apache-2.0
#include "geodb/geopackage/crs_table.hpp"

#include <charconv>
#include <string>

#include "core/error.hpp"

namespace waymark::geodb {
namespace {

constexpr std::int32_t kCartesian = -1, kGeographic = 0, kWgs84 = 4326, kFirstForeign = 100'000;
constexpr std::string_view kUndefined = "undefined";

struct Row {
  std::string name;
  std::int32_t srs_id = 0;
  std::string organization = "NONE";
  std::int64_t code = 0;
  std::string wkt1 = std::string(kUndefined), description, wkt2 = std::string(kUndefined);
};

std::int64_t code_number(const Crs& crs) {
  std::int64_t number = -1;
  std::from_chars(crs.code().data(), crs.code().data() + crs.code().size(), number);
  return number;
}

Row row_of(const Crs& crs) {
  const std::int64_t code = code_number(crs);
  const bool epsg = crs.authority() == "EPSG" && code > 0;
  Row row;
  row.name = crs.name();
  row.srs_id = epsg ? static_cast<std::int32_t>(code) : kFirstForeign;
  row.organization = crs.authority().empty() ? "NONE" : crs.authority();
  row.code = code > 0 ? code : row.srs_id;
  if (!crs.wkt1().empty()) row.wkt1 = crs.wkt1();
  row.description = crs.body().name;
  row.wkt2 = crs.wkt2();
  return row;
}

}  // namespace

std::int32_t write_crs(const sqlite::Database& database, const Crs& crs) {
  sqlite::Statement insert =
      database.prepare("INSERT OR IGNORE INTO gpkg_spatial_ref_sys VALUES (?, ?, ?, ?, ?, ?, ?)");
  const auto store = [&](const Row& row) {
    insert.bind_all(row.name, std::int64_t{row.srs_id}, row.organization, row.code, row.wkt1, row.description,
                    row.wkt2);
    insert.run();
    return row.srs_id;
  };
  store({.name = "Undefined Cartesian SRS",
         .srs_id = kCartesian,
         .code = kCartesian,
         .description = "metres on no body"});
  store({.name = "Undefined geographic SRS",
         .srs_id = kGeographic,
         .code = kGeographic,
         .description = "degrees"});
  store(row_of(Crs::from_text("EPSG:4326")));
  return crs.kind() == CrsKind::local ? kCartesian : store(row_of(crs));
}

Crs read_crs(const sqlite::Database& database, std::int32_t srs_id) {
  if (srs_id == kCartesian) return Crs::local();
  sqlite::Statement row = database.prepare(
      "SELECT organization || ':' || organization_coordsys_id, definition_12_063, definition, srs_name"
      "  FROM gpkg_spatial_ref_sys WHERE srs_id = ?");
  row.bind(1, srs_id);
  if (row.step()) {
    for (const int column : {0, 1, 2}) {
      const std::string definition(row.text(column));
      if (definition == kUndefined || definition.starts_with("NONE:")) continue;
      try {
        return Crs::from_text(definition);
      } catch (const Error&) {  // the next column may have a definition that this PROJ knows
      }
    }
  }
  throw Error(ErrorCode::input, "the map's coordinate reference system is not known to PROJ",
              "srs_id " + std::to_string(srs_id), "a newer PROJ may know it: `projinfo --version`");
}

}  // namespace waymark::geodb
