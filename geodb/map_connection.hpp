// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <filesystem>
#include <functional>
#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/layers/landmark_layout.hpp"
#include "geodb/map_store.hpp"
#include "geodb/open_map.hpp"
#include "geodb/rtree/search_windows.hpp"
namespace waymark::geodb {

/// Prepared statements that read the table of one type.
struct LandmarkTable {
  LandmarkTable(const sqlite::Database& database, const LandmarkType& type, TypeId id);

  LandmarkLayout layout;
  sqlite::Statement all, in_box, by_uid;
};

/// State shared by MapStore and MapEditor.
struct MapStore::Connection {
  Connection(std::filesystem::path file, OpenMap map);

  /// Calls `visit(row)` for the rows of a table whose boxes intersect the windows, until it returns false.
  /// Includes rows slightly outside, since boxes are float32.
  using Visit = std::function<bool(const sqlite::Statement& row)>;
  void visit(LandmarkTable& table, const SearchWindows& windows, const Visit& visit);
  LandmarkTable& table(std::string_view type);

  struct StoredLandmark {
    std::int64_t row;
    LandmarkTable* table;
    Landmark landmark;
  };
  std::optional<StoredLandmark> find(std::string_view uid);

  std::filesystem::path path;
  sqlite::Database database;
  int version;
  TypeRegistry types;
  std::int32_t srs_id;
  Crs crs;
  MapDistance map_distance;
  Envelope extent;                   ///< of all landmarks at the time of opening
  std::deque<LandmarkTable> tables;  ///< by TypeId
};

}  // namespace waymark::geodb
