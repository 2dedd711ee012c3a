// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_door(TypeRegistry& types);
void register_type_door(TypeRegistry& types) {
  constexpr double half_turn = std::numbers::pi;
  types.add({
      .name = "door",
      .summary = "Opening of a wall, as wide as a door; its position is the middle",
      .features = {{"width", "m", Scale::ratio, 0.5, 6, "Between the jambs"},
                   {"orientation", "rad", Scale::axis, -half_turn / 2, half_turn / 2,
                    "Along the wall, clockwise from north", half_turn / 18}},
      .evidence = EvidenceModel::none,  // an opening is no obstacle
      // Open half of the time.
      .existence =
          {.further_detection = 0.3, .missed_image = 0.05, .prior_penalty = 1.5, .min_probability = 0.5},
      .drawn_as = Solid::point,
      .colour = "#ef6c00",
      .label_feature = "",
      .size_feature = "width",
  });
}

}  // namespace waymark::inline landmarks
