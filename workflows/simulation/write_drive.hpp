// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>
#include "testbed/drive/drive_log.hpp"
#include "testbed/scenario.hpp"
namespace waymark::workflows {

/// Makes the drive of a scenario and writes log.jsonl, truth/track.csv and, in a forest, truth/trees.csv and
/// truth/felled.csv. A table of real trees is read relative to the scenario file. Returns a summary without
/// \n.
std::string write_drive(const std::filesystem::path& folder, const testbed::Scenario& scenario,
                        const testbed::Scene& scene, std::vector<testbed::StandingTree> trees,
                        const std::filesystem::path& scenario_file);

}  // namespace waymark::workflows
