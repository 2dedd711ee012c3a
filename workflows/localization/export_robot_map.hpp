// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
namespace waymark::workflows {

/// Landmark list of a robot's program.
enum class RobotFormat {
  beluga,  ///< YAML of the boundaries and landmarks that beluga's LandmarkMap is made from
  mrpt,    ///< section of an MRPT configuration that creates a CLandmarksMap of beacons
};

/// Returns the format named `text`, any case; `std::nullopt` for another word.
std::optional<RobotFormat> parse_robot_format(std::string_view text);

struct RobotMapExport {
  std::string map, output;
  RobotFormat format = RobotFormat::beluga;
  std::vector<std::string> types = {};  ///< empty: all
  double min_confidence = 0;
  bool overwrite = false;
};

struct ExportedRobotMap {
  std::int64_t landmarks = 0;
  std::vector<std::string> warnings = {};
};

/// Writes the landmarks in metres of the local east-north-up frame that `waymark localize` uses for the map,
/// so that poses agree. Both formats hold a position and a whole number: for beluga the category, one per
/// landmark type; for MRPT an id, one per landmark. Warns if MRPT's grid over them takes more than a
/// gigabyte. Throws Error{input} for a map without landmarks, Error{usage} for an unknown type, Error{output}
/// if the output exists and `overwrite` is false, or cannot be written.
ExportedRobotMap export_robot_map(const RobotMapExport& request);

}  // namespace waymark::workflows
