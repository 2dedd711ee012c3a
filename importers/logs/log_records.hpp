// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include "landmarks/landmark_type.hpp"
#include "landmarks/sensor_profile.hpp"
#include "localization/robot_log.hpp"
namespace waymark::importers {

/// A record of Waymark's own log format, and the line of the file that it comes from.
struct LogRecord {
  std::size_t line = 0;
  std::string json;
};

/// Reads records (docs/reference/log_format.md). `file` is named in errors and must outlive the call.
/// `sensor` gives the standard deviations of sightings that state none; `held` is as in LogImport. Throws
/// Error{input} with file and line.
localization::RobotLog read_log_records(const std::filesystem::path& file, std::span<const LogRecord> records,
                                        const TypeRegistry& types,
                                        const std::optional<SensorCoverage>& sensor = {},
                                        std::span<const TypeId> held = {});

}  // namespace waymark::importers
