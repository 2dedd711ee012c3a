// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "geodb/checks/map_checks.hpp"
#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/geopackage/shape_blob.hpp"
#include "geodb/layers/shape_table.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {

void check_shapes(const sqlite::Database& database, std::int32_t srs_id, FindingList& findings) {
  for (const ShapeLayer& layer : declared_layers(database)) {
    if (!database.has_table(layer.name)) {
      findings.add("table.missing", layer.name, std::nullopt,
                   "the map declares this layer but has no table for it");
      continue;
    }
    check_layer(database, layer.name, findings);
    sqlite::Statement row = database.prepare(
        fmt::format("SELECT id, geom FROM {} WHERE geom NOT NULL ORDER BY id", quote_identifier(layer.name)));
    while (row.step()) {
      const std::span<const std::byte> blob = row.blob(1);
      const std::vector<ShapePart> parts = parts_of(blob);
      if (parts.empty() && !envelope(blob))
        findings.add("geometry.bad", layer.name, row.integer(0), "the geometry cannot be read");
      else if (srs_id_of(blob) != srs_id)
        findings.add("geometry.crs", layer.name, row.integer(0),
                     fmt::format("the geometry has srs_id {}, the map {}", *srs_id_of(blob), srs_id));
    }
    row.reset();
    check_spatial_index(database, layer.name, findings);
  }
}

}  // namespace waymark::geodb
