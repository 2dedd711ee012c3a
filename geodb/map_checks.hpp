// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geodb/finding_list.hpp"
#include "geodb/landmark_layout.hpp"
#include "geodb/sqlite.hpp"
namespace waymark {

/// The parts of validate_map(); each adds what it finds.

/// SQLite's own checks, registered tables and styles, provenance.
void check_file(const sqlite::Database& database, const TypeRegistry& types, FindingList& findings);

/// The columns of a type's table are those the map declares; without them no further check is possible:
/// false.
bool check_columns(const sqlite::Database& database, const LandmarkLayout& layout, FindingList& findings);

/// Every row: geometry, uid, features, quality, covariance, certified bounds.
void check_landmarks(const sqlite::Database& database, const LandmarkLayout& layout, std::int32_t srs_id,
                     FindingList& findings);

/// The RTree against the geometries, its triggers, and the extent the map declares.
void check_spatial_index(const sqlite::Database& database, const std::string& table, FindingList& findings);

/// Observations, their landmarks and images, and the links between them.
void check_evidence(const sqlite::Database& database, const TypeRegistry& types, FindingList& findings);

/// Layers beside the landmarks: registered, readable, in the map's CRS, indexed.
void check_shapes(const sqlite::Database& database, std::int32_t srs_id, FindingList& findings);

/// A table with geometries is registered and has a style.
void check_layer(const sqlite::Database& database, const std::string& table, FindingList& findings);

/// One finding for every row of `sql`, which selects a row id and a text.
void find_rows(const sqlite::Database& database, FindingList& findings, const std::string& code,
               const std::string& table, const std::string& sql);

}  // namespace waymark
