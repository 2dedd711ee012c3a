// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>
#include "geo/crs.hpp"
#include "geo/image_source.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Images with poses in the frame of the map: the start of heights and orthophoto.
struct PosedImages {
  Crs crs = Crs::local();                    ///< projected or local
  ImageSet images = {};                      ///< each has `view`; sorted by name
  std::vector<Eigen::Vector3d> points = {};  ///< tie points in the grid frame, metres; empty: unknown
  std::vector<std::string> unposed = {};     ///< names of images without a pose, or that cannot be read
};

/// What ties a frame that a camera file leaves arbitrary to the map
/// (docs/how_to/tie_cameras_to_the_map.md): one of both, or neither.
struct CameraTie {
  std::string camera_crs = {};      ///< CRS of the positions, if the file names none
  std::string control_points = {};  ///< table of positions of cameras or points
};

/// Images and the file that gives their poses.
struct PosedImagesRequest {
  std::vector<std::string> images = {};  ///< files, patterns or folders; empty: those the camera file names
  std::string cameras = {};  ///< camera file in any of the formats (docs/reference/camera_formats.md)
  std::string crs = {};      ///< of the map; empty: that of the camera file
  CameraTie tie = {};
};

/// Reads images with poses. Images without a pose and files that cannot be read are dropped with a warning.
/// Throws Error{usage} for a map in degrees, Error{input} if fewer than two images remain.
PosedImages read_posed_images(const PosedImagesRequest& request, const Callbacks& callbacks = {});

/// Returns the text of a CRS for a camera file: "local", its code, else its WKT.
std::string text_of_crs(const Crs& crs);

/// Returns the camera file (docs/reference/camera_file.md) of posed images, with covariances and suns.
std::string camera_file(const PosedImages& posed);

}  // namespace waymark::workflows
