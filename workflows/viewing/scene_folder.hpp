// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/locked_folder.hpp"
#include "workflows/viewing/view.hpp"
namespace waymark::workflows {

/// The folder of a simulated scene, seen as a map of its true landmarks. The map is temporary and is removed
/// with the object.
class SceneFolder {
 public:
  /// Replaces `request.map`, a folder, by the map, and fills in DEM, cameras, images and log of the scene
  /// where the request gives none. Throws Error{usage} if the folder has no truth/landmarks.csv.
  explicit SceneFolder(ViewPageRequest& request);

 private:
  LockedFolder folder_;
};

}  // namespace waymark::workflows
