// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include "importers/logs/import_log.hpp"
#include "landmarks/landmark_type.hpp"
#include "localization/robot_log.hpp"
namespace waymark::importers {

/// A record of Waymark's own log format, and the line of the file that it comes from.
struct LogRecord {
  std::size_t line = 0;
  std::string json;
};

/// Reads records (docs/reference/log_format.md). `file` is named in errors and must outlive the call.
/// Of `how` it uses `sensor`, `held_types` and `point_detectors`. Throws Error{input} with file and line.
localization::RobotLog read_log_records(const std::filesystem::path& file, std::span<const LogRecord> records,
                                        const TypeRegistry& types, const LogImport& how = {});

}  // namespace waymark::importers
