// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include "core/options/option_reader.hpp"
#include "testbed/drive/drive_settings.hpp"
namespace waymark::testbed {

/// Reads the section `drive` of a scenario: its own fields, `waypoints`, and one object per part. Throws
/// Error{usage} with the JSON path for fields that are unknown, out of range or of the wrong kind. Warns of
/// former names.
void read_drive(DriveSettings& into, std::string_view json, const std::string& source,
                const OptionWarning& warn = {});

/// Return the section with all values, and its JSON schema.
std::string drive_json(const DriveSettings& drive);
std::string drive_schema();

}  // namespace waymark::testbed
