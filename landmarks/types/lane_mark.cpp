// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_lane_mark(TypeRegistry& types);
void register_type_lane_mark(TypeRegistry& types) {
  constexpr double half_turn = std::numbers::pi;
  using Kind = AttributeSpec::Kind;
  types.add({
      .name = "lane_mark",
      .summary = "Painted mark on a road: a dash, a stop line, an arrow",
      .features = {{"orientation", "rad", Scale::axis, -half_turn / 2, half_turn / 2,
                    "Long side, clockwise from north", half_turn / 8},
                   {"length", "m", Scale::ratio, 0.05, 100, "Long side"},
                   {"width", "m", Scale::ratio, 0.05, 10, "Short side"}},
      .attributes = {{"kind", "", Kind::text, "Dash, stop line, arrow or as the source calls it"}},
      .evidence = EvidenceModel::none,
      .drawn_as = Solid::point,
      .colour = "#9e9d24",
      .label_feature = "",
      .size_feature = "length",
  });
}

}  // namespace waymark::inline landmarks
