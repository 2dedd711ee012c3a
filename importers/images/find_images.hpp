// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "importers/cameras/camera_set.hpp"
namespace waymark::importers {

/// Expected path of an image, and its name.
struct FoundImage {
  std::string path;
  std::string name;                     ///< unique: the file name, with folders if two files share it
  const ImageCamera* camera = nullptr;  ///< of the given set; null if it has none
};

/// Finds the images in `files` and those that `cameras` names.
/// - A folder stands for the images in it, not below; a pattern for the files it matches, and nothing else.
/// - Images of `cameras` are searched in the folders given. If `files` is empty, in the folder of the camera
///   file, and in `images` inside it and beside it.
/// Returns them sorted by name. A path that does not exist is listed as well.
/// Throws Error{input} for a pattern that matches no file.
std::vector<FoundImage> find_images(const std::vector<std::string>& files, const CameraSet* cameras,
                                    const std::string& camera_file);

/// Returns whether a name has the extension of an image file.
bool is_image_name(const std::string& name);

/// Lists the files that match a pattern, sorted: `*`, `?` and `[...]` in its last component. Returns a path
/// without them unchanged.
std::vector<std::string> expand_pattern(const std::string& pattern);

/// Lists the images in a folder, not below, sorted; empty if there is no such folder.
std::vector<std::string> image_files_in(const std::string& folder);

}  // namespace waymark::importers
