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

/// Keeps in the work folder what a run took: per stage of which it made units, and for the map if it wrote
/// one
/// (`map_seconds`, 0: none). Memory is the largest of this process. A cost that cannot be written is left
/// out, since no result depends on it.
void keep_costs(const pipeline::RunOptions& options, const pipeline::RunReport& report, double map_seconds);

/// What the calls of a plan ask for, by the costs kept in its work folder.
struct MeasuredResources {
  std::map<std::string, pipeline::CallResources> by_stage;  ///< "map": the call that writes the map
  std::vector<std::string> unknown;  ///< stages of which no cost is kept, unless all is done
};

/// Returns what each call needs by the largest costs that are kept: their threads, 1.5 times the memory, 3
/// times the time. A call asks for 100 MB and a minute at least. A stage over tiles or images has at most
/// `max_shards` calls.
MeasuredResources measured_resources(const std::filesystem::path& work, const pipeline::Plan& plan,
                                     std::size_t max_shards);

}  // namespace waymark::workflows
