// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <limits>
#include "geo/local_frame.hpp"
#include "localization/robot_log.hpp"
#include "localization/track.hpp"
namespace waymark::workflows {

/// Writes the layers `track` (a line with times) and, for a harvester, `harvested` (a point per felled tree
/// with t, diameter, height, sd) into a map file. `frame`: of track and log. The write is atomic. Trees
/// felled after `until` (s) are left out, so it may be called while the track grows.
void write_drive_layers(const std::filesystem::path& map, const localization::RobotLog& log,
                        const localization::Track& track, const LocalFrame& frame,
                        double until = std::numeric_limits<double>::infinity());

/// Rewrites these layers while a track grows: every `every` seconds of the log, and after each felled tree.
class LiveLayers {
 public:
  LiveLayers(std::filesystem::path map, const localization::RobotLog& log, const LocalFrame& frame,
             double every);
  void operator()(const localization::Track& so_far);

 private:
  std::filesystem::path map_;
  const localization::RobotLog* log_;
  LocalFrame frame_;
  double every_, next_ = 0;
  std::size_t felled_ = 0;
};

}  // namespace waymark::workflows
