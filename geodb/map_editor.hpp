// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <string_view>
#include "geodb/map_store.hpp"
namespace waymark::geodb {

/// Editor of a map file in place.
/// - Each call is a transaction, or part of the transaction of transact().
/// - If the process is killed, the next process that opens the map rolls the transaction back.
/// - GeoPackage triggers update the RTree.
/// - One editor at a time; readers may have the file open.
class MapEditor {
 public:
  /// Opens a map and migrates an older schema version in place. Throws Error as MapStore::open, and if the
  /// file cannot be written.
  static MapEditor open(const std::filesystem::path& path);

  const MapStore& map() const { return map_; }

  /// Inserts a landmark. Throws Error if its type has no table in the map, or its uid is empty or taken.
  void insert(const Landmark& landmark);
  /// Replaces the landmark of that uid and type. Throws Error if there is none.
  void update(const Landmark& landmark);
  /// Removes a landmark. Its observations remain, rejected with the reason "landmark removed".
  void remove(std::string_view uid);
  /// Stores an observation of a landmark of the map and counts it there. The caller merges the values.
  void add_evidence(const Observation& observation);
  void add_image(const ImageRecord& image);
  void add_run(const RunRecord& run);

  /// Runs `changes` in one transaction; none is stored if it throws. Faster than separate calls, since the
  /// disk is flushed once.
  void transact(const std::function<void()>& changes);

 private:
  explicit MapEditor(MapStore map);
  MapStore map_;
  bool in_transaction_ = false;
};

}  // namespace waymark::geodb
