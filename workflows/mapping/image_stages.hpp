// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/engine/pipeline.hpp"
namespace waymark::workflows {

/// Landmarks that a job of images searches for; mountain tops are those of the DEM.
struct ImageFinds {
  bool rocks = true, craters = true, mountain_tops = false;
};

/// Returns what a list such as "rocks,craters" selects. Throws Error{usage} for other words and for none.
ImageFinds parse_image_finds(std::string_view list);

/// Returns the stages from the detections to valued landmarks, in order, after the DEM and the images are
/// loaded. Without `known_sun` it is not compared with shadows.
std::vector<std::string> image_stages(const ImageFinds& find, bool known_sun = true);

/// Images and what places them on the ground.
struct ImageFiles {
  std::vector<std::string> images = {};  ///< files, patterns or folders; empty: those that `cameras` names
  std::string cameras = {};              ///< camera file or pattern; empty: the images are orthophotos
  std::vector<std::string> dem = {};     ///< empty: level ground at height 0
  std::string crs = {};                  ///< of the DEM instead of its own, or of level ground
  double height_sd = 0;                  ///< metres, of a height of the ground; 0: not known
};

/// Appends all stages that map the landmarks of images. Throws Error{usage} without images and cameras, or
/// for mountain tops without a DEM.
void add_image_stages(pipeline::Pipeline& pipeline, const ImageFiles& files, const ImageFinds& find = {});

}  // namespace waymark::workflows
