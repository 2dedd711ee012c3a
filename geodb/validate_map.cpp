// SPDX-License-Identifier: Apache-2.0
#include "geodb/validate_map.hpp"

#include "core/error.hpp"
#include "geodb/crs_table.hpp"
#include "geodb/map_checks.hpp"
#include "geodb/open_map.hpp"
#include "geodb/type_catalogue.hpp"

namespace waymark {

std::vector<Finding> validate_map(const std::filesystem::path& path) {
  const OpenMap map = open_for_reading(path);
  const sqlite::Database& database = map.database;
  const TypeRegistry types = read_types(database);
  FindingList findings;
  check_file(database, types, findings);

  const auto srs_id = static_cast<std::int32_t>(
      database.integer("SELECT srs_id FROM gpkg_geometry_columns WHERE table_name = 'image'"));
  try {
    read_crs(database, srs_id);
  } catch (const Error& error) {
    findings.add("crs.unknown", "gpkg_spatial_ref_sys", srs_id, error.problem());
  }
  bool whole = true;
  for (TypeId id = 0; id < types.size(); ++id) {
    const LandmarkLayout layout(types[id], id);
    if (!check_columns(database, layout, findings)) {
      whole = false;
      continue;
    }
    check_landmarks(database, layout, srs_id, findings);
    check_spatial_index(database, types[id].name, findings);
  }
  check_shapes(database, srs_id, findings);
  if (whole) check_evidence(database, types, findings);
  return findings.take();
}

}  // namespace waymark
