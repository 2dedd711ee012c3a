// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
namespace waymark::exporters {

/// Returns whether the files of this GDAL driver are text whose landmarks count_rows can count.
bool has_rows_of_text(const std::string& driver);

/// Counts the landmarks of a finished KML, ODS or XLSX file as text, in constant memory: GDAL's readers hold
/// the whole file, 1.8 kB a landmark, and refuse large ODS files. `std::nullopt` if the file does not end as
/// it should.
std::optional<std::int64_t> count_rows(const std::string& driver, const std::string& path);

}  // namespace waymark::exporters
