// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_wall_end(TypeRegistry& types);
void register_type_wall_end(TypeRegistry& types) {
  constexpr double half_turn = std::numbers::pi;
  types.add({
      .name = "wall_end",
      .summary = "Upright edge where a wall stops in the open: a door jamb, the end of a partition",
      .features = {{"direction", "rad", Scale::direction, -half_turn, half_turn,
                    "Normal of the seen face, clockwise from north", half_turn / 18},
                   {"side", "", Scale::interval, -1, 1,
                    "Where the wall lies for who looks at the face: 1 left of the end, -1 right", 0.5}},
      .evidence = EvidenceModel::upright,
      .existence =
          {.further_detection = 0.3, .missed_image = 0.1, .prior_penalty = 1.5, .min_probability = 0.5},
      .drawn_as = Solid::point,
      .colour = "#00acc1",
      .label_feature = "",
      .size_feature = "",
  });
}

}  // namespace waymark::inline landmarks
