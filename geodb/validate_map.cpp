// SPDX-License-Identifier: Apache-2.0
#include "geodb/validate_map.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/error.hpp"
#include "geodb/checks/map_checks.hpp"
#include "geodb/geopackage/crs_table.hpp"
#include "geodb/geopackage/layer_registration.hpp"
#include "geodb/geopackage/type_catalogue.hpp"
#include "geodb/open_map.hpp"

namespace waymark::geodb {

namespace {

std::vector<Finding> findings_of(const sqlite::Database& database) {
  const TypeRegistry types = read_types(database);
  FindingList findings;
  check_file(database, types, findings);

  const std::int32_t srs_id = srs_id_of_map(database);
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
    check_edit_triggers(database, types[id].name, findings);
  }
  check_shapes(database, srs_id, findings);
  if (whole) check_evidence(database, types, findings);
  return findings.take();
}

/// Returns the findings about numbers that tables, reports and pages show.
std::vector<Finding> value_findings(const sqlite::Database& database) {
  constexpr std::array<std::string_view, 5> kCodes{"feature.range", "feature.spread", "quality.range",
                                                   "covariance.bad", "geometry.bad"};
  const TypeRegistry types = read_types(database);
  const std::int32_t srs_id = srs_id_of_map(database);
  FindingList findings;
  for (TypeId id = 0; id < types.size(); ++id) {
    const LandmarkLayout layout(types[id], id);
    if (check_columns(database, layout, findings)) check_landmarks(database, layout, srs_id, findings);
  }
  std::vector<Finding> all = findings.take();
  std::erase_if(all, [&](const Finding& one) { return std::ranges::find(kCodes, one.code) == kCodes.end(); });
  return all;
}

/// Throws Error{input} with the first finding, if there is one.
void refuse_findings(const std::vector<Finding>& findings, const std::filesystem::path& map,
                     const std::string& problem) {
  if (findings.empty()) return;
  const Finding& first = findings.front();
  const std::string table = first.table.empty() ? "" : ", table " + first.table;
  const std::string row = first.row ? ", row " + std::to_string(*first.row) : "";
  throw Error(ErrorCode::input, problem + first.text, map.string() + table + row,
              "`waymark validate` lists them; run its job again");
}

}  // namespace

std::vector<Finding> validate_map(const std::filesystem::path& path) {
  const OpenMap map = open_for_reading(path);
  return with_map_name(path, [&] { return findings_of(map.database); });
}

void check_before_reading(const std::filesystem::path& map) {
  const OpenMap opened = open_for_reading(map);
  const std::vector<Finding> findings = with_map_name(map, [&] { return value_findings(opened.database); });
  refuse_findings(findings, map, "the map has errors, and what is made of it would be wrong: ");
}

void check_before_copy(const std::filesystem::path& map) {
  refuse_findings(validate_map(map), map, "the map has errors that its copy would have, too: ");
}

}  // namespace waymark::geodb
