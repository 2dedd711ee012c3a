// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_beacon(TypeRegistry& types);
void register_type_beacon(TypeRegistry& types) {
  types.add({
      .name = "beacon",
      .summary = "Post or tag put up for robots; may say who it is (bar code, reflector)",
      .features = {{"height", "m", Scale::ratio, 0.01, 100, "Ground to top"},
                   {"diameter", "m", Scale::ratio, 0.001, 10, "Width of the post"}},
      .evidence = EvidenceModel::upright,
      .body = {"diameter", 0.5},
      .identifies_itself = true,
      .drawn_as = Solid::cylinder,
      .colour = "#1565c0",
      .label_feature = "",
      .size_feature = "",
  });
}

}  // namespace waymark::inline landmarks
