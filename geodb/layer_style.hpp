// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "landmarks/landmark_type.hpp"
namespace waymark {

/// How a type is drawn: marker by `drawn_as` in `colour`, its size growing with the logarithm of
/// `size_feature`, `label_feature` written beside it, larger values first where labels collide. Documents of
/// QGIS 3 (QML) and OGC (SLD 1.1), on many lines.
std::string qml_style(const LandmarkType& type);
std::string sld_style(const LandmarkType& type);

}  // namespace waymark
