// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>
#include "exporters/records/lonlat_footprint.hpp"
namespace waymark::exporters {

/// File that a record refers to.
struct RecordAsset {
  std::string key = {}, href = {}, type = {}, title = {};  ///< type: media type
  std::vector<std::string> roles = {};
  std::int64_t bytes = 0;
  std::string sha256 = {};  ///< 64 hexadecimal digits
};

/// Facts of a map or raster. Times are ISO 8601, UTC.
struct RecordFacts {
  std::string id = {}, title = {}, description = {};
  Crs crs = Crs::local();
  std::optional<MapBox> box = {};                              ///< none: nothing is placed
  std::string created = {};                                    ///< when it was made
  std::string first_image = {}, last_image = {};               ///< when its images were taken; empty: unknown
  std::optional<double> sun_azimuth = {}, sun_elevation = {};  ///< degrees, of all images alike; else none
  std::optional<double> gsd = {};                              ///< metres, of the finest image
  std::optional<std::array<double, 6>> transform = {};         ///< of a raster, as GDAL's geotransform
  std::array<std::int64_t, 2> shape{};                         ///< rows and columns of a raster
  std::string software_version = {};                           ///< of Waymark; empty: made by another program
  std::string lineage = {};                                    ///< command line
  std::vector<std::pair<std::string, std::int64_t>> landmarks = {};  ///< number per type
  std::vector<RecordAsset> assets = {};
};

/// Returns a STAC Item 1.1.0 as JSON. Extensions: projection 2.0.0, file 2.1.0, and where they apply solar
/// system 1.1.0, view 1.1.0 and processing 1.2.0.
/// - A local CRS has no place on a body: the geometry is null, `proj:bbox` holds the extent.
/// - `collection` is the id of the collection that lists the item as collection.json beside it; empty: none.
std::string stac_item(const RecordFacts& facts, const std::string& collection = {});

/// Returns a STAC Collection 1.1.0 as JSON, with links to `<id>.json` of its items. Items without a place do
/// not count for its extent; if none has one, it is the whole body.
std::string stac_collection(const std::string& id, const std::string& description,
                            std::span<const RecordFacts> items);

}  // namespace waymark::exporters
