// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include "geodb/map_contents.hpp"
#include "geodb/map_query.hpp"
namespace waymark {

/// A map file opened for reading; it is never written to, and nothing is left beside it. Any number of
/// readers, and one MapEditor, may have the file open. Movable; one thread at a time: open one per thread.
class MapStore {
 public:
  /// A map of an older schema version is migrated in a private copy; one whose last update was killed is
  /// rolled back there. Throws Error: no such file, not a GeoPackage, a GeoPackage that is not a Waymark map,
  /// a map of a newer version.
  static MapStore open(const std::filesystem::path& path);
  ~MapStore();
  MapStore(MapStore&&) noexcept;
  MapStore& operator=(MapStore&&) noexcept;

  const std::filesystem::path& path() const;
  int schema_version() const;         ///< of the file, before any migration
  const TypeRegistry& types() const;  ///< as the file declares them: also types this program does not know
  const Crs& crs() const;
  std::int64_t count() const;
  std::int64_t count(std::string_view type) const;  ///< throws Error{usage} for a type the map does not have

  /// About 50 us for ten hits among a million landmarks. A feature no chosen type has is an Error{usage}.
  std::vector<Landmark> query(const MapQuery& query) const;
  std::optional<Landmark> find(std::string_view uid) const;
  /// Ground distance in metres as the queries measure it.
  double distance(const Landmark& landmark, double x, double y) const;

  std::vector<Observation> observations_of(std::string_view uid) const;  ///< kept ones, in order of storing
  std::vector<Observation> observations() const;                         ///< all, rejected ones too
  /// All landmarks of a type, or all observations, one at a time in order of storing: for maps larger than
  /// memory. Throws Error{usage} for a type the map does not have.
  void visit(std::string_view type, const std::function<void(Landmark&&)>& visit) const;
  /// Those of a box on a plane (not across the antimeridian), edges included.
  void visit(std::string_view type, const MapQuery::Box& box,
             const std::function<void(Landmark&&)>& visit) const;
  void visit_observations(const std::function<void(Observation&&)>& visit) const;
  /// Kept ones of a type's landmarks in a box on a plane, and perhaps of some just outside.
  void visit_observations(std::string_view type, const MapQuery::Box& box,
                          const std::function<void(Observation&&)>& visit) const;
  std::vector<ImageRecord> images() const;
  std::vector<RunRecord> runs() const;  ///< oldest first
  bool has_dem_coverage() const;        ///< read it with GDAL as "GPKG:<path>:dem"

  struct Connection;  ///< private to geodb

 private:
  friend class MapEditor;
  explicit MapStore(std::unique_ptr<Connection> connection);
  std::unique_ptr<Connection> connection_;
};

}  // namespace waymark
