// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_traffic_sign(TypeRegistry& types);
void register_type_traffic_sign(TypeRegistry& types) {
  constexpr double half_turn = std::numbers::pi;
  using Kind = AttributeSpec::Kind;
  types.add({
      .name = "traffic_sign",
      .summary = "Traffic sign on its post",
      .features = {{"facing", "rad", Scale::direction, -half_turn, half_turn,
                    "Normal of the face, clockwise from north", half_turn / 8},
                   {"height", "m", Scale::ratio, 0.2, 12, "Ground to the middle of the face"}},
      .attributes = {{"code", "", Kind::text, "What it says, as the source codes it"}},
      .evidence = EvidenceModel::upright,
      .drawn_as = Solid::point,
      .colour = "#f9a825",
      .label_feature = "",
      .size_feature = "",
  });
}

}  // namespace waymark::inline landmarks
