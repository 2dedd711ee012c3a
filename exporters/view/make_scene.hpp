// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "exporters/view/view_images.hpp"
#include "exporters/view/view_scene.hpp"
#include "geo/local_frame.hpp"
#include "geodb/map_store.hpp"
#include "localization/robot_log.hpp"
#include "localization/track.hpp"
namespace waymark::exporters {

struct NamedTrack {
  std::string name;
  localization::Track track;  ///< map frame
};

/// What a view is made of.
struct ViewRequest {
  std::string title = {};              ///< empty: the name of the map file
  std::vector<std::string> dems = {};  ///< empty: those of the map or its run
  std::string orthophoto = {};         ///< empty: shaded relief
  std::vector<NamedTrack> tracks = {};
  const localization::RobotLog* log = nullptr;  ///< map frame; null: none
  std::vector<PosedImageFile> images = {};
  std::int64_t max_landmarks = 24000;  ///< drawn, of all types
};

/// Makes the scene of a map. `frame` is the map frame of tracks and log.
/// - The terrain is the DEM's, if that is at most four times as wide as landmarks, tracks and images, else
///   the part about them.
/// - On a body, what is farther from the middle than a quarter of its radius is left out, with a note.
/// Throws Error{input} for a map without landmarks, terrain and tracks, and as make_view_terrain().
ViewScene make_view_scene(const geodb::MapStore& map, const LocalFrame& frame, const ViewRequest& request);

}  // namespace waymark::exporters
