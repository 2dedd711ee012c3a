// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/ready_rules.hpp"
namespace waymark::importers {

void register_ready_rules_trees(ReadyRules& rules);
void register_ready_rules_trees(ReadyRules& rules) {
  rules["trees"] = {
      .summary =
          "Tree cadastres: points with height, stem and crown; lengths are metres unless the cell has a unit",
      .json = R"json({
  "waymark_rules": 1,
  "position_sd": 0.3,
  "rules": [
    {"type": "tree", "geometry": "centroid", "where": {"height_m": "*"},
     "features": {"height": "height_m", "diameter": "dbh_cm/100", "crown_diameter": "crown_m"}},
    {"type": "tree", "geometry": "centroid", "where": {"baumhoehe": "*"},
     "features": {"height": "baumhoehe", "diameter": "stammumfg/100/pi", "crown_diameter": "kronedurch"}},
    {"type": "tree", "geometry": "centroid", "where": {"hauteur": "*"},
     "features": {"height": "hauteur", "diameter": "circonference/100/pi"}},
    {"type": "tree", "geometry": "centroid", "where": {"tree_dbh": "*"}, "features": {"diameter": "tree_dbh*0.0254"}},
    {"type": "tree", "geometry": "centroid",
     "features": {"height": "height", "diameter": "diameter", "crown_diameter": "crown_diameter"}}
  ]
}
)json"};
}

}  // namespace waymark::importers
