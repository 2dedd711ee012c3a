// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>
#include "geodb/layers/landmark_layout.hpp"
#include "geodb/sqlite/sqlite.hpp"
#include "geodb/validate_map.hpp"
namespace waymark::geodb {

/// Collects findings: the first hundred of each code and table, and the number of the others.
class FindingList {
 public:
  void add(std::string code, std::string table, std::optional<std::int64_t> row, std::string text);
  std::vector<Finding> take();

 private:
  std::vector<Finding> findings_;
  std::map<std::pair<std::string, std::string>, std::int64_t> count_;  ///< by code and table
};

/// Checks of validate_map(); each adds its findings.

/// Checks the integrity of the file, registered tables and styles, and provenance.
void check_file(const sqlite::Database& database, const TypeRegistry& types, FindingList& findings);

/// Checks that a type's table has the declared columns. Returns false if not; further checks are then
/// impossible.
bool check_columns(const sqlite::Database& database, const LandmarkLayout& layout, FindingList& findings);

/// Checks each row: geometry, uid, features, quality, covariance, certified bounds.
void check_landmarks(const sqlite::Database& database, const LandmarkLayout& layout, std::int32_t srs_id,
                     FindingList& findings);

/// Checks that the triggers are there that keep a type's table sound when other programs edit it.
void check_edit_triggers(const sqlite::Database& database, const std::string& table, FindingList& findings);

/// Checks the RTree against the geometries, its triggers, and the declared extent.
void check_spatial_index(const sqlite::Database& database, const std::string& table, FindingList& findings);

/// Checks observations, their landmarks and images, and the links between them.
void check_evidence(const sqlite::Database& database, const TypeRegistry& types, FindingList& findings);

/// Checks that shape layers are registered, readable, in the map's CRS and indexed.
void check_shapes(const sqlite::Database& database, std::int32_t srs_id, FindingList& findings);

/// Checks that a table with geometries is registered and has a style.
void check_layer(const sqlite::Database& database, const std::string& table, FindingList& findings);

/// Adds one finding for each row of `sql`, which selects a row id and a text.
void find_rows(const sqlite::Database& database, FindingList& findings, const std::string& code,
               const std::string& table, const std::string& sql);

}  // namespace waymark::geodb
