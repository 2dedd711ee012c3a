// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "exporters/report/landmark_section.hpp"
#include "exporters/report/map_view.hpp"
namespace waymark {

/// Markers and labels of the foremost landmarks, in the manner of layer_style: shape by `drawn_as`, colour of
/// the type, size growing with `size_feature`; bowls are drawn true to scale where that is large enough to
/// see, other markers shrink where they would cover more than 6 % of the map. Labels that would cover one
/// another or a marker of a labelled landmark are left out.
struct MapMarkers {
  std::string svg;
  std::size_t drawn = 0;  ///< of all sections together
  std::size_t total = 0;
};
MapMarkers draw_markers(const MapView& view, const std::vector<LandmarkSection>& sections);

/// The symbol of a type on its own, for legends: `size` drawing units.
std::string svg_symbol(const LandmarkType& type, double size);

}  // namespace waymark
