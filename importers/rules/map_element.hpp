// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "geo/crs.hpp"
#include "geo/geometry_part.hpp"
#include "importers/rules/drawing_unit.hpp"
namespace waymark::importers {

/// Thing of a GIS layer: a node or way of OSM, a feature of a shapefile, an entity of a drawing.
struct MapElement {
  std::string layer;
  std::int64_t number = 0;                  ///< of the feature
  std::map<std::string, std::string> tags;  ///< tags and columns that have a value
  std::vector<GeometryPart> parts;          ///< in the coordinates of the file
};

/// The elements of a file, read one by one. One thread at a time may use it.
class ElementSource {
 public:
  virtual ~ElementSource() = default;
  virtual std::optional<Crs> crs() const = 0;
  /// Returns the unit that a drawing states for its coordinates.
  virtual std::optional<DrawingUnit> unit() const { return {}; }
  /// Reads the next element; returns false at the end. Throws Error{input} if the file breaks off.
  virtual bool next(MapElement& element) = 0;
  /// Begins again at the first element.
  virtual void restart() = 0;
};

/// Opens a CityJSON file, or any vector file that GDAL reads; `layer` limits it to one layer. Throws
/// Error{input}.
/// - Tags that GDAL's OSM driver collects in `other_tags` are tags like the others.
/// - Lanelet2 maps with the tags local_x and local_y have local coordinates if `local` asks for them, or if
/// no
///   node has a latitude and longitude other than 0. Such files are held in memory.
/// - Curves become lines. Of a CityJSON object with several geometries the lowest level of detail is its
///   outline.
std::unique_ptr<ElementSource> open_elements(const std::string& path, const std::string& layer = {},
                                             bool local = false);

// Open files of one kind.
std::unique_ptr<ElementSource> open_ogr_elements(const std::string& path, const std::string& layer);
std::unique_ptr<ElementSource> open_cityjson_elements(const std::string& path);
std::unique_ptr<ElementSource> open_local_osm_elements(const std::string& path);

/// Returns whether a node of an OSM file has a latitude and longitude other than 0. Throws Error{input}.
bool has_geographic_nodes(const std::string& path);

/// Parses tags as PostgreSQL's hstore writes them: `"natural"=>"tree","height"=>"12"`.
void read_hstore(const std::string& text, std::map<std::string, std::string>& tags);

}  // namespace waymark::importers
