// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include "testbed/drive/drive_settings.hpp"
namespace waymark {

/// The section `drive` of a scenario: its own fields, `waypoints`, and one object for each part. Throws
/// Error{usage} with the JSON path for what is unknown, out of range or of the wrong kind.
void read_drive(DriveSettings& into, std::string_view json, const std::string& source);

/// The section with every value written out, and its JSON schema.
std::string drive_json(const DriveSettings& drive);
std::string drive_schema();

}  // namespace waymark
