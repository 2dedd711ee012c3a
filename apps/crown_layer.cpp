// SPDX-License-Identifier: Apache-2.0
#include "apps/crown_layer.hpp"

namespace waymark {

ShapeLayer crown_layer(std::span<const CrownShape> crowns) {
  ShapeLayer layer{
      .name = "crown",
      .summary = "Crowns of trees, seen from above",
      .kind = ShapeKind::polygon,
      .columns = {{.name = "tree_uid", .unit = "", .kind = AttributeSpec::Kind::text, .summary = "uid of the tree"},
                  {.name = "height", .unit = "m", .summary = "Height of the tree"},
                  {.name = "area", .unit = "m2", .summary = "Area of the crown"},
                  {.name = "diameter", .unit = "m", .summary = "Diameter of the circle of that area"}},
      .style = {.colour = "#1b5e20", .fill = "#66bb6a"}};
  for (const CrownShape& crown : crowns)
    layer.rows.push_back({.parts = {{.outer = crown.ring}},
                          .values = {crown.uid, crown.height, crown.area, crown.diameter}});
  return layer;
}

}  // namespace waymark
