// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_building(TypeRegistry& types);
void register_type_building(TypeRegistry& types) {
  constexpr double half_turn = std::numbers::pi;
  using Kind = AttributeSpec::Kind;
  types.add({
      .name = "building",
      .summary = "Building; its position is the middle of its outline",
      .features = {{"height", "m", Scale::ratio, 1, 1000, "Ground to the highest edge of the roof"},
                   {"diameter", "m", Scale::ratio, 1, 3000, "Of the circle of the outline's area"},
                   {"orientation", "rad", Scale::axis, -half_turn / 2, half_turn / 2,
                    "Longer side of the outline, clockwise from north", half_turn / 4}},
      .attributes = {{"name", "", Kind::text, "Name or number in the source"}},
      .evidence = EvidenceModel::upright,
      .body = {"diameter", 0.5},
      .identification_reach = 1000,
      .drawn_as = Solid::point,
      .colour = "#8d6e63",
      .label_feature = "",
      .size_feature = "diameter",
  });
}

}  // namespace waymark::inline landmarks
