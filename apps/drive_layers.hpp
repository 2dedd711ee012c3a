// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include "geo/local_frame.hpp"
#include "localization/robot_log.hpp"
#include "localization/track.hpp"
namespace waymark {

/// Writes the layers `track` (one line and its points' times) and, of a harvester, `harvested` (a point per felled
/// tree with t, diameter, height, sd) into a map file. `frame`: of track and log. All or nothing.
void write_drive_layers(const std::filesystem::path& map, const RobotLog& log, const Track& track,
                        const LocalFrame& frame);

}  // namespace waymark
