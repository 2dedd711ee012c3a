// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "exporters/report/landmark_section.hpp"
#include "exporters/report/map_view.hpp"
namespace waymark::exporters {

/// Markers and labels of the foremost landmarks.
struct MapMarkers {
  std::string svg;
  std::size_t drawn = 0;  ///< of all sections together
  std::size_t total = 0;
};
/// Draws the foremost landmarks in the style of layer_style: shape by `drawn_as`, colour of the type, size by
/// `size_feature`.
/// - Bowls are drawn to scale if that is large enough to see; other markers shrink if they would cover more
///   than 6 % of the map.
/// - Labels that would cover one another or a marker of a labelled landmark are omitted.
MapMarkers draw_markers(const MapView& view, const std::vector<LandmarkSection>& sections);

/// Returns the attributes by which the script of a report finds a landmark: uid, confidence and quality.
std::string landmark_attributes(const Landmark& landmark);

/// Returns the symbol of a type for legends, `size` drawing units wide.
std::string svg_symbol(const LandmarkType& type, double size);

}  // namespace waymark::exporters
