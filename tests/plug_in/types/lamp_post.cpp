// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"
namespace waymark::test {

// Drawn like a rock and with a radius, but seen as a pole.
void register_type_lamp_post(TypeRegistry& types);
void register_type_lamp_post(TypeRegistry& types) {
  types.add({.name = "lamp_post",
             .summary = "Street light",
             .features = {{"radius", "m", Scale::ratio, 0.05, 2, "Of the pole"},
                          {"height", "m", Scale::ratio, 2, 20, "Ground to lamp"}},
             .evidence = EvidenceModel::upright,
             .body = {"radius"},
             .identification_reach = 400,
             .existence = {.min_probability = 0.6},
             .drawn_as = Solid::cylinder,
             .label_feature = "height",
             .size_feature = "radius"});
}

}  // namespace waymark::test
