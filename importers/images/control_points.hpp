// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "importers/images/camera_file.hpp"
#include "importers/images/similarity.hpp"
namespace waymark {

/// What control points say about a frame.
struct Georeferencing {
  Similarity map_from_frame;
  std::string report;  ///< number of points, scale, residual; one line
};

/// Reads control points: CSV with a header, `frame_x,frame_y,frame_z,x,y,z` for points of the frame, or
/// `image,x,y,z` for the places of cameras. x, y, z in the grid frame, metres. Throws Error{input} naming the
/// line for what is missing or no number, for an image the camera file has no pose for, and as
/// estimate_similarity.
Georeferencing read_control_points(const std::string& path, const CameraFile& cameras);

/// "scale,qw,qx,qy,qz,x,y,z": map = scale * rotation * frame + shift. Throws Error{usage}.
Similarity similarity_from_text(const std::string& text);

}  // namespace waymark
