// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include "geodb/geometry_blob.hpp"
#include "geodb/landmark_layout.hpp"
#include "geodb/sqlite.hpp"
namespace waymark {

/// What GeoPackage wants to know of a table or view with geometries.
struct Layer {
  std::string table, description, geometry_type;
  bool z = false;
  Envelope extent;  ///< empty: NULL
  std::int32_t srs_id = 0;
  std::string changed;  ///< time stamp
};
void register_layer(const sqlite::Database& database, const Layer& layer);

/// Creates "rtree_<table>_geom" with its triggers (sql/rtree.sql).
void create_spatial_index(const sqlite::Database& database, std::string_view table);

/// Titles, descriptions and plausible ranges of a type's columns (schema extension).
void describe_columns(const sqlite::Database& database, const LandmarkLayout& layout);

/// `<type>_observation`, which links landmarks to their evidence (related tables extension).
void create_evidence_links(const sqlite::Database& database, const std::string& type);

/// The style QGIS draws a table with when it opens the map, and the same for readers of SLD.
void store_style(const sqlite::Database& database, std::string_view table, const std::string& qml,
                 const std::string& sld, std::string_view summary, std::string_view changed);

/// The view `landmark`: what all landmarks have in common, whatever their type.
void create_landmark_view(const sqlite::Database& database, const TypeRegistry& types);

}  // namespace waymark
