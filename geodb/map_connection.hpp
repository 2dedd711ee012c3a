// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <filesystem>
#include <functional>
#include "geodb/geometry_blob.hpp"
#include "geodb/landmark_layout.hpp"
#include "geodb/map_store.hpp"
#include "geodb/open_map.hpp"
#include "geodb/search_windows.hpp"
namespace waymark {

/// The statements that read the table of one type, prepared once.
struct LandmarkTable {
  LandmarkTable(const sqlite::Database& database, const LandmarkType& type, TypeId id);

  LandmarkLayout layout;
  sqlite::Statement all, in_box, of_uid;
};

/// What MapStore and MapEditor share.
struct MapStore::Connection {
  Connection(std::filesystem::path file, OpenMap map);

  /// Calls `visit(row)` for the rows of a table whose boxes meet the windows; it may be a little more than
  /// asked for, since boxes are float32.
  using Visit = std::function<void(const sqlite::Statement& row)>;
  void visit(LandmarkTable& table, const SearchWindows& windows, const Visit& visit);
  LandmarkTable& table(std::string_view type);

  struct Found {
    std::int64_t row;
    LandmarkTable* table;
    Landmark landmark;
  };
  std::optional<Found> find(std::string_view uid);

  std::filesystem::path path;
  sqlite::Database database;
  int version;
  TypeRegistry types;
  std::int32_t srs_id;
  Crs crs;
  GroundRuler ruler;
  Envelope extent;                   ///< of all landmarks, when the map was opened
  std::deque<LandmarkTable> tables;  ///< by TypeId
};

}  // namespace waymark
