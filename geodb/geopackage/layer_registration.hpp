// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/layers/landmark_layout.hpp"
#include "geodb/sqlite/sqlite.hpp"
namespace waymark::geodb {

/// Description of a table or view with geometries for the GeoPackage.
struct Layer {
  std::string table, description, geometry_type;
  bool z = false;
  Envelope extent;  ///< empty: NULL
  std::int32_t srs_id = 0;
  std::string changed;  ///< time stamp
};
/// Registers a layer in gpkg_contents and gpkg_geometry_columns.
void register_layer(const sqlite::Database& database, const Layer& layer);

/// Creates "rtree_<table>_geom" with its triggers (sql/rtree.sql).
void create_spatial_index(const sqlite::Database& database, std::string_view table);

/// Registers the layer `image`; its spatial index is created first, before the rows.
void register_images(const sqlite::Database& database, const Envelope& extent, std::int32_t srs_id,
                     std::string_view changed);

/// Returns the srs_id of the map, which all its layers share.
std::int32_t srs_id_of_map(const sqlite::Database& database);

/// Creates the triggers that name new landmarks of a table and note moved ones (sql/edits.sql).
void create_edit_triggers(const sqlite::Database& database, std::string_view table);

/// Stores titles, descriptions and plausible ranges of a type's columns (schema extension).
void describe_columns(const sqlite::Database& database, const LandmarkLayout& layout);

/// Creates `<type>_observation`, which links landmarks to their observations (related tables extension).
void create_evidence_links(const sqlite::Database& database, const std::string& type);

/// Stores the default style of a table for QGIS, and the same style as SLD.
void store_style(const sqlite::Database& database, std::string_view table, const std::string& qml,
                 const std::string& sld, std::string_view summary, std::string_view changed);

/// Creates the view `landmark`: the common columns of all landmark types.
void create_landmark_view(const sqlite::Database& database, const TypeRegistry& types);

}  // namespace waymark::geodb
