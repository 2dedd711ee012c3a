// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>
#include "geodb/map_contents.hpp"
#include "pipeline/engine/runner.hpp"
namespace waymark {

/// Whether every stage that writes landmarks has written them. Images that failed do not prevent it.
bool makes_map(const Pipeline& pipeline, const RunResult& result);

/// All that the stages of a run made for a map: `landmarks`, and where there are images, `evidence` and
/// `image_views`; `crowns` become the layer crown. Stage by stage. Landmarks, evidence and crowns are taken
/// out of the result; those of tiles are parts, read while the map is written.
MapContents map_of_run(RunResult& result, RunRecord run, bool with_dem);

/// What map_of_run and summary_of_run ask a run for (RunOptions::results).
std::vector<std::string> artifacts_of_a_map();

/// Landmark types the stages find, whether any is there or not.
std::vector<std::string> types_found(const Pipeline& pipeline);

/// Where the map is, what it holds and how fast it was made; no rate where earlier results were used again.
/// `written`: landmarks by type.
std::string summary_of_run(const RunResult& result, const MapContents& contents,
                           const std::map<std::string, std::int64_t>& written, const std::string& map);

}  // namespace waymark
