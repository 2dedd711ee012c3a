// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "importers/images/camera_set.hpp"
namespace waymark {

/// Where an image should be, and the name it goes by.
struct FoundImage {
  std::string path;
  std::string name;                     ///< unique: the file's, with folders where two are the same
  const ImageCamera* camera = nullptr;  ///< of the set given, if there is one
};

/// Images among `files` (folders: those in them, not below; patterns: those that match) and those that
/// `cameras` names, looked for in the folders given; where `files` is empty, in the folder of the camera
/// file, in `images` in it and beside it. In the order of their names. A path that does not exist is listed
/// all the same.
std::vector<FoundImage> find_images(const std::vector<std::string>& files, const CameraSet* cameras,
                                    const std::string& camera_file);

/// Whether a name ends as image files do.
bool is_image_name(const std::string& name);

/// The files a pattern names, sorted: `*`, `?` and `[...]` in its last component; a path without them is
/// itself.
std::vector<std::string> matching(const std::string& pattern);

/// Paths of the images in a folder, not below, sorted; none where there is no such folder.
std::vector<std::string> image_files_in(const std::string& folder);

}  // namespace waymark
