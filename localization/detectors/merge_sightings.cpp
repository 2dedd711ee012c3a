// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/merge_sightings.hpp"

#include <algorithm>
#include <tuple>

namespace waymark::localization {
namespace {

constexpr double kSameObject = 0.3;  // m: the smallest jump in range between two objects of a detector

using ObjectSightings = std::vector<SeenLandmark>;  // at most one of each detector

double distance(const SeenLandmark& a, const SeenLandmark& b) {
  const double x = *a.range * std::cos(*a.bearing) - *b.range * std::cos(*b.bearing);
  const double y = *a.range * std::sin(*a.bearing) - *b.range * std::sin(*b.bearing);
  return std::hypot(x, y);
}

/// Adds each sighting to the nearest object, one to one, or as an object of its own.
void add_sightings(std::vector<ObjectSightings>& objects, const std::vector<SeenLandmark>& sightings) {
  struct Pair {
    double distance;
    std::size_t object, sighting;
  };
  std::vector<Pair> pairs;
  for (std::size_t o = 0; o < objects.size(); ++o)
    for (std::size_t s = 0; s < sightings.size(); ++s)
      if (objects[o][0].has_position() && sightings[s].has_position())
        if (const double d = distance(objects[o][0], sightings[s]); d < kSameObject)
          pairs.push_back({d, o, s});
  std::ranges::sort(pairs, {}, [](const Pair& p) { return std::tuple(p.distance, p.object, p.sighting); });
  std::vector<bool> is_taken(objects.size(), false), is_added(sightings.size(), false);
  for (const Pair& p : pairs) {
    if (is_taken[p.object] || is_added[p.sighting]) continue;
    is_taken[p.object] = is_added[p.sighting] = true;
    objects[p.object].push_back(sightings[p.sighting]);
  }
  for (std::size_t s = 0; s < sightings.size(); ++s)
    if (!is_added[s]) objects.push_back({sightings[s]});
}

SeenLandmark merge(const ObjectSightings& of_object, const FeatureScales& scales) {
  SeenLandmark merged = *std::ranges::max_element(of_object, {}, &SeenLandmark::range_sd);
  if (std::ranges::all_of(of_object, [&](const SeenLandmark& s) { return s.type == merged.type; }))
    return merged;
  merged.type = {}, merged.features = {};
  if (std::ranges::any_of(of_object, &SeenLandmark::may_be_anything)) return merged;
  for (const SeenLandmark& s : of_object)
    if (!merged.features_as(*s.type))
      merged.possible_types.push_back({*s.type, features_without_angles(scales, *s.type, s.features)});
  return merged;
}

}  // namespace

SightingSet merge_sightings(std::span<const SightingSet> sets, const FeatureScales& scales) {
  std::vector<ObjectSightings> objects;
  for (const SightingSet& set : sets) add_sightings(objects, set.sightings);
  SightingSet merged;
  if (!sets.empty()) merged.robot_from_sensor = sets[0].robot_from_sensor;
  for (const ObjectSightings& object : objects) merged.sightings.push_back(merge(object, scales));
  return merged;
}

}  // namespace waymark::localization
