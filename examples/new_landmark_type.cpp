// SPDX-License-Identifier: Apache-2.0
// Declares a landmark type; merging, quality, map columns, style and queries follow from it.
#include <array>
#include <iostream>
#include <waymark/map.hpp>
using namespace waymark;

namespace {

LandmarkType lamp_post() {
  return {.name = "lamp_post",
          .summary = "Street light; seen from above by its shadow, from the road as a thin pole",
          .features = {{"height", "m", Scale::ratio, 2, 20, "Ground to lamp"},
                       {"diameter", "m", Scale::ratio, 0.05, 0.6, "Of the pole at breast height"}},
          .drawn_as = Solid::cylinder,
          .colour = "#e0a020",
          .label_feature = "height"};
}

/// Merges three sightings of a post; a fourth image shows its position, but not the post.
Landmark merge_sightings(TypeId type, const LandmarkType& spec) {
  const std::array<WeightedValue, 3> heights{{{7.9, 0.8}, {8.2, 0.9}, {8.0, 0.5}}};
  const std::array<WeightedValue, 3> diameters{{{0.14, 0.8}, {0.16, 0.9}, {0.21, 0.5}}};
  Landmark post;
  post.type = type;
  post.position = {{13.3777, 52.5163, 34}};
  post.features = {merge(heights, Scale::ratio), merge(diameters, Scale::ratio)};
  post.observations = 3;
  post.quality = {.seen = 3, .visible = 4, .feature_confidences = {}};
  for (std::size_t i = 0; i < spec.features.size(); ++i)
    post.quality.feature_confidences.push_back(
        spread_confidence(post.features[i], spec.features[i].scale, spec.features[i].reference));
  return post;
}

}  // namespace

int main() {
  geodb::MapContents map;
  const TypeId type = map.types.add(lamp_post());
  map.crs = Crs::from_text("EPSG:4326");
  map.landmarks = {merge_sightings(type, map.types[type])};
  assign_uids(map.types, map.crs, map.landmarks);
  geodb::write_map("lamp_posts.gpkg", map);

  // The type is stored in the file, so programs without it can read the map.
  const geodb::MapStore store = geodb::MapStore::open("lamp_posts.gpkg");
  for (const LandmarkType& known : store.types()) std::cout << known.name << ": " << known.summary << '\n';
  for (const Landmark& post : store.query({.features = {{"height", 5, 10}}}))
    std::cout << post.uid << ": " << post.features[0].value << " m high, quality "
              << quality_of(store.types()[post.type], post).value_or(0) << '\n';
  return store.count("lamp_post") == 1 ? 0 : 1;
}
