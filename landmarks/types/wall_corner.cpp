// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_wall_corner(TypeRegistry& types);
void register_type_wall_corner(TypeRegistry& types) {
  constexpr double half_turn = std::numbers::pi;
  types.add({
      .name = "wall_corner",
      .summary = "Upright edge where two walls meet, seen from one side",
      .features = {{"direction", "rad", Scale::direction, -half_turn, half_turn,
                    "Bisector into the open, clockwise from north", half_turn / 18},
                   {"opening_angle", "rad", Scale::interval, 0, 2 * half_turn,
                    "Through the open: above pi the corner is convex", half_turn / 18}},
      .evidence = EvidenceModel::upright,
      .existence =
          {.further_detection = 0.3, .missed_image = 0.1, .prior_penalty = 1.5, .min_probability = 0.5},
      .drawn_as = Solid::point,
      .colour = "#00695c",
      .label_feature = "",
      .size_feature = "",
  });
}

}  // namespace waymark::inline landmarks
