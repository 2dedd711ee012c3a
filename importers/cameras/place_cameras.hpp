// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "importers/cameras/camera_file.hpp"
#include "importers/cameras/camera_set.hpp"
namespace waymark::importers {

/// Transforms the poses of a camera file into the grid frame of the map. `path` is for messages.
CameraSet place_cameras(const CameraFile& file, const std::string& path, const CameraImport& import);

}  // namespace waymark::importers
