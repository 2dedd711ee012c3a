// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_curb(TypeRegistry& types);
void register_type_curb(TypeRegistry& types) {
  constexpr double half_turn = std::numbers::pi;
  types.add({
      .name = "curb",
      .summary = "Straight piece of a kerb, at its face; its position is the middle, known across it only",
      .features = {{"direction", "rad", Scale::direction, -half_turn, half_turn,
                    "Normal towards the lower surface, clockwise from north", half_turn / 18},
                   {"length", "m", Scale::ratio, 0.1, 1000, "Length of the piece"},
                   {"height", "m", Scale::ratio, 0.02, 0.5, "Lower to upper surface"}},
      .evidence = EvidenceModel::none,
      .drawn_as = Solid::point,
      .colour = "#a1887f",
      .label_feature = "",
      .size_feature = "length",
  });
}

}  // namespace waymark::inline landmarks
