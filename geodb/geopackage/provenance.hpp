// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "geodb/map_contents.hpp"
#include "geodb/sqlite/sqlite.hpp"
namespace waymark::geodb {

/// Write and read table `run`. A RunRecord reads back unchanged, except for its time: see time_stamp().
void write_run(const sqlite::Database& database, const RunRecord& run);
std::vector<RunRecord> read_runs(const sqlite::Database& database);

/// Write and read table `image`, with footprints as multipolygons.
void write_image(const sqlite::Database& database, const ImageRecord& image, std::int32_t srs_id);
std::vector<ImageRecord> read_images(const sqlite::Database& database);

/// Writes the provenance of the map as dataset metadata of the file (metadata extension, Dublin Core in XML).
void write_metadata(const sqlite::Database& database, const RunRecord& run, std::string_view changed);

/// Converts "2026-11-21T07:21:14Z" to GeoPackage's "2026-11-21T07:21:14.000Z". Returns the epoch if the text
/// is not a time, so that no clock affects a file.
std::string time_stamp(std::string_view iso_8601);
std::string time_stamp_now();

}  // namespace waymark::geodb
