// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include "testbed/drive/drive_log.hpp"
#include "testbed/scene.hpp"
#include "workflows/callbacks.hpp"
#include "workflows/simulation/drive_report.hpp"
namespace waymark::workflows {

/// Drive along a planned route.
struct RouteDrive {
  std::string log, true_track;  ///< text of log.jsonl and truth/track.csv
  localization::Track track;    ///< estimated while driving, map frame
  DriveReport report;
};

/// Drives the vehicle along a route by its estimated pose. Everything that it knows comes from the log, the
/// map and the route; the truth only moves it and scores it.
/// - It plans again when its sd exceeds the plan, landmarks turn out to be gone, or its sensors see an
///   obstacle on its path. It stands and looks again before an obstacle it saw only once.
/// - `scenario_folder`: files of the section `navigation` are relative to it.
/// - Deterministic for a seed and any number of threads.
/// Throws Error{input} for a route that cannot be read or begins outside the site.
RouteDrive drive_route(const testbed::DriveWorld& world, const testbed::Scene& scene,
                       const testbed::LogCrs& place, const std::filesystem::path& scenario_folder,
                       const Callbacks& callbacks);

}  // namespace waymark::workflows
