// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/ready_rules.hpp"
namespace waymark::importers {

void register_ready_rules_cityjson(ReadyRules& rules);
void register_ready_rules_cityjson(ReadyRules& rules) {
  rules["cityjson"] = {.summary = "CityJSON: buildings, their corners and facades, trees, lamps and posts",
                       .json = R"json({
  "waymark_rules": 1,
  "position_sd": 0.3,
  "rules": [
    {"type": "building", "geometry": "centroid", "where": {"type": "Building"},
     "features": {"height": "measuredHeight"}, "attributes": {"name": "id"}},
    {"type": "wall_corner", "geometry": "corners", "where": {"type": ["Building", "BuildingPart"]}, "except": {"parts": "*"}},
    {"type": "wall", "geometry": "walls", "where": {"type": ["Building", "BuildingPart"]}, "except": {"parts": "*"},
     "min_length": 2,
     "features": {"height": "measuredHeight"}},
    {"type": "tree", "geometry": "centroid", "where": {"type": "SolitaryVegetationObject"},
     "features": {"height": "height", "crown_diameter": "crownDiameter", "diameter": "trunkDiameter"}},
    {"type": "pole", "geometry": "centroid", "where": {"type": "CityFurniture"}, "features": {"height": "height"},
     "attributes": {"kind": "function"}, "confidence": 0.7}
  ]
}
)json"};
}

}  // namespace waymark::importers
