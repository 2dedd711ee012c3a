// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_wall(TypeRegistry& types);
void register_type_wall(TypeRegistry& types) {
  constexpr double half_turn = std::numbers::pi;
  types.add({
      .name = "wall",
      .summary = "Straight piece of a wall or facade; its position is the middle, known across the wall only",
      .features = {{"direction", "rad", Scale::direction, -half_turn, half_turn,
                    "Normal of the seen face, clockwise from north", half_turn / 18},
                   {"length", "m", Scale::ratio, 0.1, 1000, "Length of the piece"},
                   {"height", "m", Scale::ratio, 0.1, 500, "Ground to top"}},
      .evidence = EvidenceModel::upright,
      .drawn_as = Solid::point,
      .colour = "#455a64",
      .label_feature = "",
      .size_feature = "length",
  });
}

}  // namespace waymark::inline landmarks
