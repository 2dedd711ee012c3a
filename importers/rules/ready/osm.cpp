// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/ready_rules.hpp"
namespace waymark::importers {

void register_ready_rules_osm(ReadyRules& rules);
void register_ready_rules_osm(ReadyRules& rules) {
  rules["osm"] = {
      .summary = "OpenStreetMap: lamps, masts, bollards, signs, trees, entrances, buildings, walls",
      .json = R"json({
  "waymark_rules": 1,
  "position_sd": 2,
  "rules": [
    {"type": "pole", "where": {"highway": "street_lamp"}, "features": {"height": "height", "diameter": "diameter"},
     "attributes": {"kind": "highway"}},
    {"type": "pole", "where": {"power": ["pole", "portal"]}, "features": {"height": "height"},
     "attributes": {"kind": "power"}},
    {"type": "pole", "where": {"barrier": "bollard"}, "features": {"height": "height", "diameter": "diameter"},
     "attributes": {"kind": "barrier"}},
    {"type": "pole", "where": {"man_made": ["mast", "flagpole", "utility_pole"]}, "features": {"height": "height"},
     "attributes": {"kind": "man_made"}},
    {"type": "pole", "where": {"highway": "traffic_signals"}, "attributes": {"kind": "highway"}, "confidence": 0.7},
    {"type": "traffic_sign", "where": {"traffic_sign": "*"}, "features": {"facing": "rad(direction)"},
     "attributes": {"code": "traffic_sign"}},
    {"type": "traffic_sign", "where": {"highway": ["stop", "give_way"]}, "attributes": {"code": "highway"},
     "confidence": 0.5},
    {"type": "tree", "where": {"natural": "tree"},
     "features": {"height": "height", "crown_diameter": "diameter_crown", "diameter": "circumference/pi"}},
    {"type": "door", "where": {"entrance": "*"}, "except": {"entrance": "no"}, "features": {"width": "width"}, "confidence": 0.7},
    {"type": "building", "geometry": "outline", "where": {"building": "*"}, "except": {"building": "no"},
     "features": {"height": "height"}, "attributes": {"name": "name"}},
    {"type": "wall_corner", "geometry": "corners", "of": "outlines", "where": {"building": "*"},
     "except": {"building": ["no", "roof"]}, "position_sd": 1, "confidence": 0.8},
    {"type": "wall", "geometry": "walls", "of": "outlines", "where": {"building": "*"},
     "except": {"building": ["no", "roof"]}, "position_sd": 1, "min_length": 2, "features": {"height": "height"}, "confidence": 0.8},
    {"type": "wall", "geometry": "walls", "where": {"barrier": ["wall", "retaining_wall", "city_wall"]},
     "min_length": 2, "features": {"height": "height"}}
  ]
}
)json"};
}

}  // namespace waymark::importers
