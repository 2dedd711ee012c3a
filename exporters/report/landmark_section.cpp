// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/landmark_section.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exporters/export_columns.hpp"
#include "geodb/map_store.hpp"

namespace waymark {
namespace {

void put_foremost_first(LandmarkSection& section) {
  const auto by = find_feature(section.type, section.type.size_feature);
  std::vector<std::pair<double, Landmark>> ranked;
  ranked.reserve(section.landmarks.size());
  for (Landmark& landmark : section.landmarks) {
    const double rank = by ? value_of(landmark, by) : equal_weight_quality(landmark).value_or(-1);
    ranked.emplace_back(std::isnan(rank) ? -std::numeric_limits<double>::infinity() : rank,
                        std::move(landmark));
  }
  std::sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second.uid < b.second.uid;
  });
  for (std::size_t i = 0; i < ranked.size(); ++i) section.landmarks[i] = std::move(ranked[i].second);
}

}  // namespace

std::vector<LandmarkSection> landmark_sections(const MapStore& map) {
  std::vector<LandmarkSection> sections;
  for (const LandmarkType& type : map.types()) {
    sections.push_back({type, map.query({.types = {type.name}})});
    put_foremost_first(sections.back());
  }
  return sections;
}

std::optional<std::size_t> find_feature(const LandmarkType& type, const std::string& name) {
  for (std::size_t i = 0; i < type.features.size(); ++i)
    if (type.features[i].name == name) return i;
  return {};
}

double value_of(const Landmark& landmark, std::optional<std::size_t> feature) {
  const bool known = feature && *feature < landmark.features.size() && landmark.features[*feature].known();
  return known ? landmark.features[*feature].value : std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> known_values(const LandmarkSection& section, std::size_t feature) {
  std::vector<double> values;
  for (const Landmark& landmark : section.landmarks)
    if (const double value = value_of(landmark, feature); std::isfinite(value)) values.push_back(value);
  return values;
}

}  // namespace waymark
