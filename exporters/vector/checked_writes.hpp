// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
namespace waymark::exporters {

/// Returns a name under which GDAL writes the file `path` and every failure is counted: its drivers of text
/// formats do not report a write that fails.
std::string with_checked_writes(const std::string& path);

/// Returns how many writes to such files have failed in this process.
std::int64_t failed_writes();

}  // namespace waymark::exporters
