// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include "geodb/map_contents.hpp"
#include "geodb/map_query.hpp"
namespace waymark::geodb {

/// Map file opened for reading. It never writes the file or other files beside it. Any number of readers and
/// one MapEditor may have the file open. Movable; not thread-safe: open one per thread.
class MapStore {
 public:
  /// Opens a map. A map of an older schema version, or with an interrupted transaction, is migrated or rolled
  /// back in a private copy. Throws Error if the file is missing, not a GeoPackage, not a Waymark map, or of
  /// a newer version.
  static MapStore open(const std::filesystem::path& path);
  ~MapStore();
  MapStore(MapStore&&) noexcept;
  MapStore& operator=(MapStore&&) noexcept;

  const std::filesystem::path& path() const;
  int schema_version() const;         ///< of the file, before any migration
  const TypeRegistry& types() const;  ///< declared in the file, including types unknown to this program
  const Crs& crs() const;
  std::int64_t count() const;
  std::int64_t count(std::string_view type) const;  ///< throws Error{usage} for a type that the map lacks

  /// Returns the landmarks of a query; about 50 us for ten hits among a million. Throws Error{usage} for a
  /// feature that no queried type has.
  std::vector<Landmark> query(const MapQuery& query) const;
  /// Returns the smallest and largest known value of a number of the landmarks, as in queries, of some types
  /// (none named: of all); `std::nullopt` if none is known. Reads every row.
  std::optional<std::pair<double, double>> range_of(const std::string& number,
                                                    const std::vector<std::string>& types) const;
  /// Returns the box of all landmarks; `std::nullopt` if the map has none.
  std::optional<MapQuery::Box> extent() const;
  std::optional<Landmark> find(std::string_view uid) const;
  /// Returns the horizontal distance in metres, as in queries.
  double distance(const Landmark& landmark, double x, double y) const;

  /// Returns the accepted observations of a landmark, in order of storage.
  std::vector<Observation> observations_of(std::string_view uid) const;
  std::vector<Observation> observations() const;  ///< all, including rejected ones
  /// Visits all landmarks of a type one at a time in order of storage, for maps larger than memory. Throws
  /// Error{usage} for a type that the map lacks.
  void visit(std::string_view type, const std::function<void(Landmark&&)>& visit) const;
  /// Visits the landmarks in a box, edges included; the box cannot cross the antimeridian.
  void visit(std::string_view type, const MapQuery::Box& box,
             const std::function<void(Landmark&&)>& visit) const;
  /// Rows of a type, consecutive in order of storage.
  struct RowRange {
    std::int64_t first = 0, last = 0;  ///< ids, both inclusive
  };
  /// Divides the rows of a type into ranges of `rows` rows. Throws Error{usage} for a type that the map
  /// lacks.
  std::vector<RowRange> row_ranges(std::string_view type, std::int64_t rows) const;
  /// Visits the landmarks of a range of rows.
  void visit(std::string_view type, const RowRange& range,
             const std::function<void(Landmark&&)>& visit) const;
  void visit_observations(const std::function<void(Observation&&)>& visit) const;
  /// Visits the rejected observations.
  void visit_rejected(const std::function<void(Observation&&)>& visit) const;
  /// Visits the accepted observations of the landmarks of a range of rows.
  void visit_observations(std::string_view type, const RowRange& range,
                          const std::function<void(Observation&&)>& visit) const;
  /// Visits the accepted observations of a type's landmarks in a box, and possibly of landmarks slightly
  /// outside.
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

}  // namespace waymark::geodb
