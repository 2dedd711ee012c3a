// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/landmark_section.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geodb/map_store.hpp"

namespace waymark::exporters {
namespace {

void sort_by_rank(LandmarkSection& section) {
  const auto by = find_feature(section.type, section.type.size_feature);
  std::vector<std::pair<double, Landmark>> ranked;
  ranked.reserve(section.landmarks.size());
  for (Landmark& landmark : section.landmarks) {
    const double rank =
        by ? certified_value(section.type, landmark, section.type.size_feature) : landmark.confidence;
    ranked.emplace_back(std::isnan(rank) ? -std::numeric_limits<double>::infinity() : rank,
                        std::move(landmark));
  }
  std::sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second.uid < b.second.uid;
  });
  for (std::size_t i = 0; i < ranked.size(); ++i) section.landmarks[i] = std::move(ranked[i].second);
}

}  // namespace

std::vector<LandmarkSection> landmark_sections(const geodb::MapStore& map) {
  std::vector<LandmarkSection> sections;
  for (const LandmarkType& type : map.types()) {
    sections.push_back({type, map.query({.types = {type.name}})});
    sort_by_rank(sections.back());
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

std::optional<std::size_t> lower_bound_of(const LandmarkType& type, const std::string& feature) {
  for (std::size_t i = 0; i < type.attributes.size(); ++i)
    if (type.attributes[i].name == feature + "_low") return i;
  return {};
}

double certified_value(const LandmarkType& type, const Landmark& landmark, const std::string& feature) {
  const double value = value_of(landmark, find_feature(type, feature));
  const auto bound = lower_bound_of(type, feature);
  const double* low = bound && *bound < landmark.attributes.size()
                          ? std::get_if<double>(&landmark.attributes[*bound])
                          : nullptr;
  return low != nullptr && *low < value ? *low : value;
}

std::vector<double> known_values(const LandmarkSection& section, std::size_t feature) {
  std::vector<double> values;
  for (const Landmark& landmark : section.landmarks)
    if (const double value = value_of(landmark, feature); std::isfinite(value)) values.push_back(value);
  return values;
}

}  // namespace waymark::exporters
