// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "geo/crs.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::geodb {

/// Returns the style of a landmark type for QGIS 3 (QML); sld_style() for OGC (SLD 1.1).
/// - Markers by `drawn_as` in `colour`, labels by `label_feature`; larger values win if labels collide.
/// - In QML the size grows with the logarithm of `size_feature`; bodies are to scale where that is larger.
/// - In QML points with a direction are lines to scale, or arrows.
/// - Columns have titles, landmarks a display name and a map tip.
std::string qml_style(const LandmarkType& type, const Crs& crs = Crs::local());
/// Returns the style as SLD, see qml_style().
std::string sld_style(const LandmarkType& type);

}  // namespace waymark::geodb
