// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include "testbed/drive/drive_settings.hpp"
#include "testbed/town/town.hpp"
namespace waymark::testbed {

/// A drive through a town: what the robot logs and its true track.
struct TownDrive {
  std::string log;    ///< Waymark's log format: odometry, scans, truth
  std::string track;  ///< TRACK.csv
  double distance = 0, seconds = 0;
};

/// Takes a file of the log, named relative to it. Called from several threads.
using TownFileSink = std::function<void(const std::string& name, const std::string& bytes)>;

/// Drives along the path of a town with the odometry and the laser of `settings`, on level ground.
/// Deterministic for a seed and for any number of threads. Turns of a 3-D scanner go to `sink`, one file
/// each; without it there are none.
TownDrive drive_through(const Town& town, const DriveSettings& settings, std::uint64_t seed,
                        const TownFileSink& sink = {});

/// Returns settings for a robot in a street or a hall at 1 m/s: a laser of 270 degrees, each half second,
/// with beams of a quarter of a degree to 30 m.
DriveSettings town_settings();

}  // namespace waymark::testbed
