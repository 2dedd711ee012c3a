// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include "geo/camera.hpp"
#include "importers/json_value.hpp"
namespace waymark::importers {

/// Reads a lens of Waymark's own camera file; docs/reference/camera_file.md.
Camera camera_from_json(const JsonValue& json);

/// Reads the time from the first row to the last of a lens of Waymark's own camera file, seconds; 0 if it has
/// none.
double readout_time_from_json(const JsonValue& json);

/// Reads a lens of OpenSfM and OpenDroneMap. Normalised image coordinates are pixels over max(width, height)
/// from the middle of the image: u = (f x + c_x) max(w, h) + w / 2 - 0.5, where (0, 0) is the centre of the
/// first pixel.
Camera camera_from_opensfm(const JsonValue& json);

/// Reads interior orientations by name from a separate file: `cameras` of Waymark's camera file, OpenSfM's
/// reconstruction.json or cameras.json, or the YAML of Orthority (im_size, focal_len, sensor_size, cx, cy,
/// distortion). Throws Error{input} for any other file.
std::map<std::string, Camera> read_interior(const std::string& path);

/// Returns the lens of that name, or the only one in the file. Throws Error{input} with the file if there is
/// none.
Camera interior_named(const std::map<std::string, Camera>& all, const std::string& name,
                      const std::string& path);

}  // namespace waymark::importers
