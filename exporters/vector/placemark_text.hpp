// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "core/landmark.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::exporters {

/// Returns the name of a landmark for a globe or a navigator: its attribute `name`, else type and label.
std::string placemark_name(const Landmark& landmark, const LandmarkType& type);
/// Returns an HTML table: each feature with its spread, and the confidence in the landmark.
std::string placemark_description(const Landmark& landmark, const LandmarkType& type);

}  // namespace waymark::exporters
