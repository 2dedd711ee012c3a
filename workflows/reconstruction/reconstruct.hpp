// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "workflows/callbacks.hpp"
#include "workflows/mapping/make_map.hpp"
#include "workflows/reconstruction/pose_photos.hpp"
#include "workflows/reconstruction/posed_images.hpp"
namespace waymark::workflows {

/// Last product of a reconstruction; each needs those before it.
enum class ReconstructUntil {
  poses,  ///< cameras.json
  dem,    ///< and dem.tif
  ortho,  ///< and orthophoto.tif, job.json
};

/// Images and what to make of them.
struct ReconstructRequest : PosePhotosRequest, CameraTie {
  std::string cameras = {};  ///< camera file with the poses, which names the images if none are given; empty:
                             ///< they are solved; `control` then ties them to the map
  double cell = 0;           ///< of the DEM, metres; 0: twice the median ground sample distance
  std::string aoi = {};      ///< polygons: DEM and orthophoto cover the box around them; empty: all
  ReconstructUntil until = ReconstructUntil::ortho;
  std::string map = {};           ///< GeoPackage of landmarks; empty: none
  std::string command_line = {};  ///< recorded in the map
};

/// What was made.
struct ReconstructResult {
  std::size_t images = 0;             ///< with poses
  std::size_t failed = 0;             ///< without
  std::int64_t cells = 0, kept = 0;   ///< of the DEM; with a height
  std::string crs = {};               ///< of poses and products; empty: the frame is arbitrary
  std::optional<MapResult> map = {};  ///< if a map was requested

  /// Returns the exit code of the program.
  int exit_code() const {
    const int of_map = map ? map->exit_code() : 0;
    return of_map != 0 ? of_map : failed > 0 ? 3 : 0;
  }
};

/// Makes a DEM with its accuracy, an orthophoto and a job from images, and the map of landmarks on request.
/// Throws Error{usage} for a request in conflict, Error{input} for images that cannot be reconstructed,
/// Error{output} before any work is done for a folder that cannot be written.
/// Messages: warnings of the images, a summary per product.
ReconstructResult reconstruct(const ReconstructRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
