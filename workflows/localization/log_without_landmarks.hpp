// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "localization/robot_log.hpp"
#include "localization/track.hpp"
namespace waymark::workflows {

/// Returns a warning if at most one in a thousand returns of the laser scans lies within the scanner's range:
/// ranges in millimetres, or a wrong limit. Else one if whole scans have ranges of 0 or less only. Empty
/// otherwise, and without scans.
std::string unusable_ranges_warning(const localization::RobotLog& log);

/// Returns a warning if the track used no sighting: it is dead reckoning, with fixes if the log has any.
/// Empty otherwise, and for a pose graph.
std::string dead_reckoning_warning(const localization::RobotLog& log, const localization::Track& track);

}  // namespace waymark::workflows
