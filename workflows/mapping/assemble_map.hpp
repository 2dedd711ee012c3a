// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>
#include "geodb/map_contents.hpp"
#include "pipeline/engine/runner.hpp"
namespace waymark::workflows {

/// Returns true if every stage that writes landmarks has written them all. Failed images do not matter.
bool has_all_landmarks(const pipeline::Pipeline& pipeline, const pipeline::RunResult& result);

/// Collects the contents of a map from the artifacts of a run, stage by stage: `landmarks`, and with images
/// `evidence` and `image_views`. `crowns` become the layer crown. Landmarks, evidence and crowns are moved
/// out of the result; those of tiles are parts that are read while the map is written. `types`: those of the
/// run; must outlive the contents.
geodb::MapContents assemble_map(pipeline::RunResult& result, const TypeRegistry& types, geodb::RunRecord run,
                                bool with_dem);

/// Returns the artifacts that assemble_map() and summarize_run() read (RunOptions::results).
std::vector<std::string> map_artifacts();

/// Returns the landmark types that the stages find, sorted.
std::vector<std::string> detected_types(const pipeline::Pipeline& pipeline);

/// Returns two lines: the map with its landmarks by type (`written`), and the speed of the run. The speed is
/// left out where earlier results were reused.
std::string summarize_run(const pipeline::RunResult& result, const geodb::MapContents& contents,
                          const std::map<std::string, std::int64_t>& written, const std::string& map);

}  // namespace waymark::workflows
