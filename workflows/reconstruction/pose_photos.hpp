// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "pipeline/reconstruction/adjustment/lens_ladder.hpp"
#include "pipeline/reconstruction/reconstruction.hpp"
#include "workflows/callbacks.hpp"
#include "workflows/reconstruction/read_photos.hpp"
namespace waymark::workflows {

struct PosePhotosRequest {
  std::vector<std::string> images = {};  ///< files, patterns or folders
  std::string folder = {};               ///< for the products
  std::string lens = {};                 ///< camera file whose lens is kept fixed; empty: self-calibration
  double readout_time = 0;               ///< s from the first row to the last, where `lens` states none
  std::string control = {};              ///< surveyed points; empty: none
  std::string marks = {};                ///< table of their marks; empty: `control` is a gcp_list.txt
  std::string altimeter = {};            ///< table of heights of images; empty: none
  std::string dem =
      {};  ///< coarse DEM, start of heights, and the reference if there is no other; empty: none
  std::string map_image = {};  ///< orthophoto of the site, the reference if there is no better; empty: none
  std::string crs = {};        ///< of the map; empty: that of camera file or references, else a UTM zone
  double max_pixels = 8e6;     ///< larger images are reduced to find features
  std::string work = {};       ///< folder that keeps the results of steps for later runs; empty: none
  int threads = 0;             ///< 0: one per processor
};

/// Poses of a set of pictures.
struct PosedPhotos {
  pipeline::Reconstruction scene = {};  ///< of the largest component
  std::string crs = {};                 ///< empty: the frame is arbitrary
  std::size_t posed = 0;
  double gps_rms = 0;                        ///< residuals of the positions in plan, metres; 0: none are used
  std::vector<std::string> messages = {};    ///< about lens and frame
  std::vector<UnusedPhoto> failures = {};    ///< images without a pose
  std::vector<std::size_t> components = {};  ///< images of each, largest first
  std::vector<pipeline::LadderStep> ladder = {};
  std::vector<pipeline::ControlResult> control = {};  ///< empty if the frame is arbitrary
  std::size_t pairs_tried = 0, pairs_matched = 0;
};

/// Solves the poses of pictures and writes cameras.json, colmap/, points.ply and, in a metric frame,
/// points.las into the folder. Throws Error{input} if no two images can be oriented, with what to do, and as
/// photo_control() does.
PosedPhotos pose_photos(const PosePhotosRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
