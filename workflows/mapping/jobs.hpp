// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "pipeline/engine/pipeline.hpp"
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

}  // namespace waymark::workflows
