// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_pillar(TypeRegistry& types);
void register_type_pillar(TypeRegistry& types) {
  types.add({
      .name = "pillar",
      .summary = "Column of a hall or a car park, round or square",
      .features = {{"diameter", "m", Scale::ratio, 0.1, 5, "Width at the height of the sensor"},
                   {"height", "m", Scale::ratio, 0.3, 60, "Floor to ceiling"}},
      .evidence = EvidenceModel::upright,
      .body = {"diameter", 0.5},
      .existence = {.further_detection = 0.3, .missed_image = 0.3, .min_probability = 0.5},
      .drawn_as = Solid::cylinder,
      .colour = "#6d4c41",
      .label_feature = "",
      .size_feature = "diameter",
  });
}

}  // namespace waymark::inline landmarks
