// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "core/landmark.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark {

class MapStore;

/// All landmarks of one type, foremost first: by the feature that sizes their symbol, else by quality; the
/// unknown last, equals by uid.
struct LandmarkSection {
  LandmarkType type;
  std::vector<Landmark> landmarks;
};
std::vector<LandmarkSection> landmark_sections(const MapStore& map);

/// Index of the feature of that name; nothing for an empty or unknown name.
std::optional<std::size_t> find_feature(const LandmarkType& type, const std::string& name);

/// Value of a feature; NaN where it is not known.
double value_of(const Landmark& landmark, std::optional<std::size_t> feature);

/// All known values of a feature, unsorted.
std::vector<double> known_values(const LandmarkSection& section, std::size_t feature);

}  // namespace waymark
