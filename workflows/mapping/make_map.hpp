// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>
#include "pipeline/engine/job.hpp"
#include "pipeline/engine/pipeline.hpp"
#include "pipeline/engine/runner.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Appends the stages that find the mountain tops of a DEM. Files that touch or overlap are one DEM.
void add_mountain_top_stages(pipeline::Pipeline& pipeline, const std::vector<std::string>& dem);

/// Appends the stage that names mountain tops after the points of gazetteers.
void add_name_stage(pipeline::Pipeline& pipeline, const std::vector<std::string>& gazetteers);

/// Appends the stages that find the craters of a DEM.
void add_crater_stages(pipeline::Pipeline& pipeline, const std::vector<std::string>& dem);

/// Files of a canopy: canopy height models, or surface and terrain models, or laser points.
struct CanopyFiles {
  std::vector<std::string> chm = {}, dsm = {}, dtm = {}, las = {};
  bool flights = false;  ///< each file is a survey of its own; trees of several surveys are merged
  bool crowns = true;    ///< crown outlines and diameters as well as treetops
};

/// Appends the stages that find the trees of a canopy. Throws Error{usage} where the files make no canopy.
void add_tree_stages(pipeline::Pipeline& pipeline, const CanopyFiles& canopy);

/// What is found in a town besides buildings.
struct TownParts {
  bool poles = true;
  bool trees = false;  ///< those not on roofs
};

/// Appends the stages that find buildings, their walls and corners, and the other parts of a town. Throws
/// Error{usage} where the files make no canopy.
void add_building_stages(pipeline::Pipeline& pipeline, const CanopyFiles& canopy, const TownParts& parts);

/// How a job is run and where its map is written.
struct MapRequest {
  std::string map = {};           ///< output; empty: none, only the work folder grows
  pipeline::RunOptions run = {};  ///< work folder, its part to do, threads, types; see run_options()
  bool check = false;             ///< check options, wiring and files only
  bool with_dem = false;          ///< store the DEM in the map
  std::string command_line = {};  ///< recorded in the map
  std::string sensor = {};        ///< profile recorded in the map; empty: none
};

/// What a job did.
struct MapResult {
  pipeline::RunReport report;                     ///< empty for a check
  std::vector<InputFile> inputs;                  ///< files that the stages read, with hashes
  std::map<std::string, std::int64_t> landmarks;  ///< written, by type
  bool written = false;                           ///< false for a check, a shard or missing units

  /// Returns the exit code of the program.
  int exit_code() const { return report.exit_code(); }
};

/// Runs the job and writes the map. Throws Error{usage} or Error{output} before any work is done for an
/// output that cannot be written.
/// - Where single images failed the map is made of the others.
/// - A map that cannot be made is not written, and an older one is kept.
/// - Messages: a detail per input file, the table of the run and its failures, a summary of the map.
MapResult make_map(const pipeline::Job& job, const MapRequest& request, const Callbacks& callbacks = {});

/// Returns the engine's options of a request, with progress from `callbacks` and hashes of any GDAL path.
pipeline::RunOptions run_options(const MapRequest& request, const Callbacks& callbacks = {});

/// Reads a job file with all built-in stages and applies `settings` (STAGE.OPTION=VALUE). A DEM that images
/// are placed on is requested in metres. Throws Error{usage} as read_job(), and as require_files_inside()
/// if `confined`; `settings` may name any file.
pipeline::Job load_job(const std::filesystem::path& file, const std::vector<std::string>& settings = {},
                       bool confined = false);

}  // namespace waymark::workflows
