// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <string_view>
#include "geodb/map_store.hpp"
namespace waymark {

/// Changes a map file in place. Every call is a transaction of its own unless it runs inside together().
/// A process killed meanwhile leaves the map as it was: whoever opens it next rolls it back.
/// The RTree follows by the triggers any GeoPackage tool uses. One editor at a time; readers may stay.
class MapEditor {
 public:
  /// Migrates a map of an older schema version in place. Throws Error as MapStore::open does, and for a file
  /// that cannot be written.
  static MapEditor open(const std::filesystem::path& path);

  const MapStore& map() const { return map_; }

  /// The type must have a table in the map. Throws Error for a uid that is empty or taken.
  void insert(const Landmark& landmark);
  /// Replaces the landmark of that uid and type. Throws Error where there is none.
  void update(const Landmark& landmark);
  /// Its observations stay, as rejected ones with the reason "landmark removed".
  void remove(std::string_view uid);
  /// Stores an observation of a landmark of the map and counts it there; merging is the caller's business.
  void add_evidence(const Observation& observation);
  void add_image(const ImageRecord& image);
  void add_run(const RunRecord& run);

  /// All changes made by `changes`, or none if it throws. Far faster than one by one: the disk is waited for
  /// once.
  void together(const std::function<void()>& changes);

 private:
  explicit MapEditor(MapStore map);
  MapStore map_;
  bool together_ = false;
};

}  // namespace waymark
