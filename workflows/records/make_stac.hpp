// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "exporters/records/stac_item.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Request for STAC records of maps and rasters; docs/how_to/publish_as_stac.md.
struct StacRequest {
  std::vector<std::string> files;  ///< maps (.gpkg) and rasters that GDAL reads
  std::string output;              ///< item.json for one file, or a folder for a collection
  std::string collection;          ///< its id; empty: the folder's name
  std::string description;         ///< of the item or the collection
  std::string datetime;            ///< ISO 8601 UTC, of files that do not say; empty: when they were written
  std::string href;                ///< prefix of asset addresses; empty: relative paths
};

/// Records that were written.
struct StacResult {
  std::vector<std::string> items;  ///< their files, in the order of the request
  std::string collection;          ///< its file; empty: a single item
  std::string id;                  ///< of the collection or the single item
};

/// Writes an item, or a folder with collection.json and an item for each file.
/// Throws Error{usage} for two files of one name, Error{input} for a file that is neither a map nor a raster.
StacResult make_stac(const StacRequest& request, const Callbacks& callbacks);

/// Return what a record needs to know; assets have no address yet. Throw Error{input}.
exporters::RecordFacts facts_of_map(const std::string& map);
exporters::RecordFacts facts_of_raster(const std::string& raster);

}  // namespace waymark::workflows
