// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <limits>
#include "geo/local_frame.hpp"
#include "localization/robot_log.hpp"
#include "localization/track.hpp"
namespace waymark {

/// Writes the layers `track` (one line and its points' times) and, of a harvester, `harvested` (a point per
/// felled tree with t, diameter, height, sd) into a map file. `frame`: of track and log. All or nothing, so
/// that a process killed meanwhile leaves the layers of the time before. Trees felled after `until`, s, are
/// left out: it may be called while the track grows.
void write_drive_layers(const std::filesystem::path& map, const RobotLog& log, const Track& track,
                        const LocalFrame& frame, double until = std::numeric_limits<double>::infinity());

/// Writes them again and again while a track grows: every `every` seconds of the log, and after each felled
/// tree.
class LiveLayers {
 public:
  LiveLayers(std::filesystem::path map, const RobotLog& log, const LocalFrame& frame, double every);
  void operator()(const Track& so_far);

 private:
  std::filesystem::path map_;
  const RobotLog* log_;
  LocalFrame frame_;
  double every_, next_ = 0;
  std::size_t felled_ = 0;
};

}  // namespace waymark
