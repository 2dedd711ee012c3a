// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "pipeline/reconstruction/reconstruction.hpp"
#include "workflows/callbacks.hpp"
#include "workflows/reconstruction/read_photos.hpp"
namespace waymark::workflows {

struct PosePhotosRequest {
  std::vector<std::string> images = {};  ///< files, patterns or folders
  std::string folder = {};               ///< for the products; exists
  std::string lens = {};                 ///< camera file whose lens is kept fixed; empty: self-calibration
  std::string crs = {};                  ///< of the poses; empty: UTM zone of the first position
  double max_pixels = 8e6;               ///< larger images are reduced to find features
  int threads = 0;                       ///< 0: one per processor
};

/// Poses of a set of pictures.
struct PosedPhotos {
  pipeline::Reconstruction scene = {};  ///< of the largest component
  std::string crs = {};                 ///< empty: the frame is arbitrary
  std::size_t posed = 0;
  double gps_rms = 0;                        ///< residuals of the positions in plan, metres
  std::vector<std::string> messages = {};    ///< about lens and frame
  std::vector<UnusedPhoto> failures = {};    ///< images without a pose
  std::vector<std::size_t> components = {};  ///< images of each, largest first
};

/// Solves the poses of pictures and writes cameras.json, colmap/ and points.ply into the folder.
/// Throws Error{input} if no two images can be oriented, with what to do.
PosedPhotos pose_photos(const PosePhotosRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
