// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_rock(TypeRegistry& types);
void register_type_rock(TypeRegistry& types) {
  types.add({
      .name = "rock",
      .summary = "Rock or boulder: an obstacle and a landmark at close range",
      .features = {{"radius", "m", Scale::ratio, 0.01, 100, "Half the mean width"},
                   {"height", "m", Scale::ratio, 0.01, 100, "Height above the ground around it"}},
      .evidence = EvidenceModel::shadow_caster,
      .body = {"radius"},
      .identification_reach = 100,
      // False detections repeat in every image (docs/evaluation/2026-11-22-existence-weights.md).
      .existence =
          {.further_detection = 0.2, .missed_image = 0.5, .prior_penalty = 1.5, .min_probability = 0.5},
      .drawn_as = Solid::cylinder,
      .colour = "#5f5b57",
      .label_feature = "",
      .size_feature = "radius",
  });
}

}  // namespace waymark::inline landmarks
