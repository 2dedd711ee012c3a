// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/ready_rules.hpp"
namespace waymark::importers {

void register_ready_rules_lanelet2(ReadyRules& rules);
void register_ready_rules_lanelet2(ReadyRules& rules) {
  rules["lanelet2"] = {
      .summary =
          "Lanelet2 road maps: signs, lights, poles, walls with corners and ends, kerbs, dashes, stop lines",
      .json = R"json({
  "waymark_rules": 1,
  "position_sd": 0.15,
  "rules": [
    {"type": "traffic_sign", "geometry": "centroid", "where": {"type": "traffic_sign"},
     "attributes": {"code": "subtype"}},
    {"type": "pole", "geometry": "centroid", "where": {"type": ["traffic_light", "pole"]},
     "features": {"height": "height"}, "attributes": {"kind": "type"}},
    {"type": "wall", "geometry": "walls", "where": {"type": "wall"}, "features": {"height": "height"}},
    {"type": "wall_corner", "geometry": "corners", "where": {"type": "wall"}},
    {"type": "wall_end", "geometry": "ends", "where": {"type": "wall"}},
    {"type": "curb", "geometry": "walls", "where": {"type": "curbstone"}, "min_length": 1,
     "features": {"height": "height"}, "confidence": 0.5},
    {"type": "lane_mark", "geometry": "centroid", "where": {"type": "stop_line"}, "attributes": {"kind": "type"}}
  ]
}
)json"};
}

}  // namespace waymark::importers
