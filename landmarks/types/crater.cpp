// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_crater(TypeRegistry& types);
void register_type_crater(TypeRegistry& types) {
  constexpr double half_turn = std::numbers::pi;
  types.add({
      .name = "crater",
      .summary = "Impact crater: a hazard when small, a position fix when large",
      .features = {{"radius", "m", Scale::ratio, 0.5, 2e6, "Mean radius of the rim"},
                   {"depth", "m", Scale::ratio, 0, 2e4, "Rim crest to floor"},
                   {"major_axis", "m", Scale::ratio, 0.5, 4e6, "Full length of the rim ellipse"},
                   {"minor_axis", "m", Scale::ratio, 0.5, 4e6, "Full width of the rim ellipse"},
                   {"orientation", "rad", Scale::axis, -half_turn, half_turn,
                    "Major axis, clockwise from north", half_turn / 4}},
      .evidence = EvidenceModel::bowl,
      .body = {"radius"},
      .identification_reach = 1000,
      // Often missed; with a DEM all observations share its evidence
      // (docs/evaluation/2026-11-27-craters-on-landings.md).
      .existence = {.further_detection = 0.1, .missed_image = 0.1, .min_probability = 0.5},
      .drawn_as = Solid::bowl,
      .colour = "#2f6fb0",
      .label_feature = "",
      .size_feature = "radius",
  });
}

}  // namespace waymark::inline landmarks
