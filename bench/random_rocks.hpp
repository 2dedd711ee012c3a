// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>
#include "geodb/write_map.hpp"
namespace waymark::bench {

/// Returns a map of rocks at random places of a square, `side` in metres, with ten features each.
inline geodb::MapContents random_rocks(std::int64_t count, double side) {
  geodb::MapContents map;
  map.crs = Crs::from_text("EPSG:32632");
  LandmarkType type;
  type.name = "rock";
  for (int i = 0; i < 10; ++i) {
    type.features.emplace_back();
    type.features.back().name = "feature_" + std::to_string(i);
  }
  map.types.add(type);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(0, side), value(1, 100);
  map.landmarks.resize(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    Landmark& landmark = map.landmarks[i];
    landmark.uid = "rock-" + std::to_string(random());
    landmark.position.xyz = {400'000 + place(random), 5'000'000 + place(random), value(random)};
    landmark.features.resize(10);
    for (FeatureValue& feature : landmark.features) feature = {value(random), 0.25, 3};
    landmark.quality = {
        .seen = 3, .visible = 4, .feature_confidences = std::vector<std::optional<double>>(10, 0.9)};
    landmark.observations = 3;
  }
  return map;
}

}  // namespace waymark::bench
