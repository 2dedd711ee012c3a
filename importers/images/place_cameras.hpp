// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "importers/images/camera_file.hpp"
#include "importers/images/camera_set.hpp"
namespace waymark {

/// Turns what a camera file says into poses in the grid frame of the map. `path` is for messages.
CameraSet place_cameras(const CameraFile& file, const std::string& path, const CameraImport& import);

}  // namespace waymark
