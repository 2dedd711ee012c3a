// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/ready_rules.hpp"
namespace waymark::importers {

void register_ready_rules_floor_plan(ReadyRules& rules);
void register_ready_rules_floor_plan(ReadyRules& rules) {
  rules["floor_plan"] = {
      .summary =
          "Drawings (DXF) and layers of floor plans: walls, columns and doors by the names of their layers",
      .json = R"json({
  "waymark_rules": 1,
  "position_sd": 0.1,
  "rules": [
    {"type": "wall", "geometry": "walls", "where": {"Layer": ["WALL", "WALLS", "A-WALL", "Wand", "walls"]}},
    {"type": "wall_corner", "geometry": "corners", "open": "both",
     "where": {"Layer": ["WALL", "WALLS", "A-WALL", "Wand", "walls"]}},
    {"type": "wall_end", "geometry": "ends", "where": {"Layer": ["WALL", "WALLS", "A-WALL", "Wand", "walls"]}},
    {"type": "pillar", "geometry": "centroid", "where": {"Layer": ["COLUMN", "COLUMNS", "A-COLS", "columns"]}},
    {"type": "door", "geometry": "centroid", "where": {"Layer": ["DOOR", "DOORS", "A-DOOR", "doors"]},
     "features": {"width": "geom_length"}, "confidence": 0.8}
  ]
}
)json"};
}

}  // namespace waymark::importers
