// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "geodb/map_contents.hpp"
#include "geodb/sqlite.hpp"
namespace waymark {

/// Table `run`. A RunRecord reads back as it was written, with its time as time_stamp() gives it.
void write_run(const sqlite::Database& database, const RunRecord& run);
std::vector<RunRecord> read_runs(const sqlite::Database& database);

/// Table `image`, with footprints as multipolygons.
void write_image(const sqlite::Database& database, const ImageRecord& image, std::int32_t srs_id);
std::vector<ImageRecord> read_images(const sqlite::Database& database);

/// The history of the map as dataset metadata (metadata extension, Dublin Core terms in XML) of the whole
/// file.
void write_metadata(const sqlite::Database& database, const RunRecord& run, std::string_view changed);

/// "2026-11-21T07:21:14Z" as GeoPackage writes it, "2026-11-21T07:21:14.000Z". The epoch where the text is no
/// time, so that no clock gets into a file.
std::string time_stamp(std::string_view iso_8601);
std::string time_stamp_now();

}  // namespace waymark
