// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "core/landmark.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark {

/// What a globe or a navigator shows for a landmark.
std::string place_name(const Landmark& landmark, const LandmarkType& type);
/// An HTML table: each feature with its spread, and how sure we are of the landmark.
std::string place_description(const Landmark& landmark, const LandmarkType& type);

}  // namespace waymark
