// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/ready_rules.hpp"
namespace waymark::importers {

void register_ready_rules_lamps(ReadyRules& rules);
void register_ready_rules_lamps(ReadyRules& rules) {
  rules["lamps"] = {.summary = "Cadastres of street lamps and masts: points with height and diameter",
                    .json = R"json({
  "waymark_rules": 1,
  "position_sd": 0.2,
  "rules": [
    {"type": "pole", "geometry": "centroid", "where": {"lichtpunkthoehe": "*"},
     "features": {"height": "lichtpunkthoehe"}, "attributes": {"kind": "masttyp"}},
    {"type": "pole", "geometry": "centroid", "where": {"pole_height": "*"},
     "features": {"height": "pole_height"}, "attributes": {"kind": "pole_type"}},
    {"type": "pole", "geometry": "centroid",
     "features": {"height": "height", "diameter": "diameter"}, "attributes": {"kind": "kind"}}
  ]
}
)json"};
}

}  // namespace waymark::importers
