// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "exporters/report/landmark_section.hpp"
#include "exporters/view/view_frame.hpp"
#include "exporters/view/view_scene.hpp"
namespace waymark::geodb {
class MapStore;
}

namespace waymark::exporters {

/// Layers of a view and the sources of their evidence.
struct ViewLayers {
  std::vector<ViewLayer> layers;  ///< of types with landmarks
  std::vector<std::string> sources;
};

/// Makes the layers of sections: the foremost `max_landmarks` of all types together, in proportion to their
/// numbers, within `max_distance` metres of the middle of the view. Each landmark has up to eight of its
/// observations.
ViewLayers make_view_layers(const geodb::MapStore& map, const std::vector<LandmarkSection>& sections,
                            const ViewFrame& frame, std::int64_t max_landmarks, double max_distance);

}  // namespace waymark::exporters
