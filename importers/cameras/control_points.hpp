// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geo/similarity.hpp"
#include "importers/cameras/camera_file.hpp"
namespace waymark::importers {

/// Similarity from a camera frame to the map, as estimated from control points.
struct Georeferencing {
  Similarity map_from_frame;
  std::string report;  ///< number of points, scale, residual; one line
};

/// Reads control points: CSV with a header, `frame_x,frame_y,frame_z,x,y,z` for points of the frame, or
/// `image,x,y,z` for positions of cameras. x, y, z are in the grid frame, metres. Throws Error{input} with
/// the line for a missing or invalid number and for an image without a pose, and as estimate_similarity does.
Georeferencing read_control_points(const std::string& path, const CameraFile& cameras);

/// Parses "scale,qw,qx,qy,qz,x,y,z": map = scale * rotation * frame + shift. Throws Error{usage}.
Similarity similarity_from_text(const std::string& text);

}  // namespace waymark::importers
