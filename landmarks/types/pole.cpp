// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_pole(TypeRegistry& types);
void register_type_pole(TypeRegistry& types) {
  using Kind = AttributeSpec::Kind;
  types.add({
      .name = "pole",
      .summary = "Lamp, mast, bollard or post: thin, upright and seen from all sides",
      .features = {{"diameter", "m", Scale::ratio, 0.02, 2, "Width at the height of the sensor"},
                   {"height", "m", Scale::ratio, 0.3, 60, "Ground to top"}},
      .attributes = {{"kind", "", Kind::text, "Lamp, mast, bollard or as the source calls it"}},
      .evidence = EvidenceModel::upright,
      .body = {"diameter", 0.5},
      // Assumed: people and wheels look like posts, and move on.
      .existence = {.further_detection = 0.3, .missed_image = 0.3, .min_probability = 0.5},
      .drawn_as = Solid::cylinder,
      .colour = "#ad1457",
      .label_feature = "",
      .size_feature = "height",
  });
}

}  // namespace waymark::inline landmarks
