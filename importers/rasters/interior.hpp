// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include "geo/camera.hpp"
#include "importers/json_value.hpp"
namespace waymark {

/// A lens of our own camera file; docs/camera_file.md.
Camera camera_from_json(const JsonValue& json);

/// A lens of OpenSfM and OpenDroneMap. Normalised image coordinates are pixels over max(width, height) from
/// the middle of the image: u = (f x + c_x) max(w, h) + w / 2 - 0.5, where (0, 0) is the centre of the first
/// pixel.
Camera camera_from_opensfm(const JsonValue& json);

/// Interior orientations by name, from a file of their own: `cameras` of our camera file, OpenSfM's
/// reconstruction.json or cameras.json, or the YAML of Orthority (im_size, focal_len, sensor_size, cx, cy,
/// distortion). Throws Error{input} for what is none of them.
std::map<std::string, Camera> read_interior(const std::string& path);

/// The lens of that name, or the only one there is. Throws Error{input} naming the file where it is not
/// there.
Camera interior_named(const std::map<std::string, Camera>& all, const std::string& name,
                      const std::string& path);

}  // namespace waymark
