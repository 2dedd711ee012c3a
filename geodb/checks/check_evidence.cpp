// SPDX-License-Identifier: Apache-2.0
#include "core/json_text.hpp"
#include "geodb/checks/map_checks.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

constexpr const char* kDeadLink =
    R"(SELECT m.rowid, 'links landmark ' || m.base_id || ' to observation ' || m.related_id || ', but one of them is missing'
       FROM "{t}_observation" m WHERE m.base_id NOT IN (SELECT id FROM "{t}") OR m.related_id NOT IN (SELECT id FROM observation))";
constexpr const char* kNoLink =
    R"(SELECT o.id, 'accepted as evidence of ' || coalesce(o.uid, 'nothing') || ', but not linked to it' FROM observation o
       WHERE o.type = '{t}' AND o.rejected IS NULL AND o.id NOT IN
         (SELECT m.related_id FROM "{t}_observation" m JOIN "{t}" t ON t.id = m.base_id AND t.uid = o.uid))";
constexpr const char* kTooFew =
    R"(SELECT t.id, 'has ' || t.observations || ' observations, but ' || count(*) || ' are linked to it' FROM "{t}" t
       JOIN "{t}_observation" m ON m.base_id = t.id GROUP BY t.id HAVING count(*) > t.observations)";

}  // namespace

void check_evidence(const sqlite::Database& database, const TypeRegistry& types, FindingList& findings) {
  for (const auto& type : types) {
    const std::string mapping = type.name + "_observation";
    if (!database.has_table(type.name)) continue;
    if (!database.has_table(mapping)) {
      findings.add("evidence.table", type.name, std::nullopt, "table " + mapping + " is missing");
      continue;
    }
    find_rows(database, findings, "evidence.dead_link", mapping,
              substitute_keys(kDeadLink, {{"t", type.name}}));
    find_rows(database, findings, "evidence.no_link", "observation",
              substitute_keys(kNoLink, {{"t", type.name}}));
    find_rows(database, findings, "evidence.count", type.name, substitute_keys(kTooFew, {{"t", type.name}}));
  }
  find_rows(database, findings, "evidence.type", "observation",
            "SELECT id, 'type ' || type || ' is not a type of the map' FROM observation"
            "  WHERE type NOT IN (SELECT name FROM waymark_type)");
  find_rows(database, findings, "evidence.weight", "observation",
            "SELECT id, 'weight ' || weight || ' is outside (0, 1]' FROM observation WHERE NOT (weight > 0 "
            "AND weight <= 1)");
  find_rows(database, findings, "evidence.image", "observation",
            "SELECT id, 'has a pixel in ' || source || ', which is not an image of the map' FROM observation"
            "  WHERE pixel_x NOT NULL AND source NOT IN (SELECT name FROM image)");
  sqlite::Statement row = database.prepare("SELECT id, features FROM observation");
  while (row.step())
    if (find_json_fault(row.text(1)))
      findings.add("evidence.features", "observation", row.integer(0), "column features is not JSON");
}

}  // namespace waymark::geodb
