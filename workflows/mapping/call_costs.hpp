// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>
#include "pipeline/engine/report.hpp"
#include "pipeline/engine/runner.hpp"
namespace waymark::workflows {

/// Keeps in the work folder what the stages took whose units a run made. Memory is the largest of this
/// process. A cost that cannot be written is left out, since no result depends on it.
void keep_costs(const pipeline::RunOptions& options, const pipeline::RunReport& report);

/// Keeps in the same way what a run took that wrote the map, `seconds` of them for the map itself.
void keep_cost_of_map(const pipeline::RunOptions& options, const pipeline::RunReport& report, double seconds);

/// What the calls of a plan ask for, by the costs kept in its work folder.
struct MeasuredResources {
  std::map<std::string, pipeline::CallResources> by_stage;  ///< "map": the call that writes the map
  std::vector<std::string> unknown;                         ///< stages with units to do and no kept cost
};

/// Returns what each call needs by the largest costs that are kept: their threads, 1.5 times the memory, 3
/// times the time. A call asks for 100 MB and a minute at least. A stage over tiles or images has at most
/// `max_shards` calls.
MeasuredResources measured_resources(const std::filesystem::path& work, const pipeline::Plan& plan,
                                     std::size_t max_shards);

}  // namespace waymark::workflows
