// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_tree(TypeRegistry& types);
void register_type_tree(TypeRegistry& types) {
  types.add({
      .name = "tree",
      .summary = "Single tree, its position where the stem meets the ground",
      .features = {{"height", "m", Scale::ratio, 1, 130, "Ground to highest shoot"},
                   {"diameter", "m", Scale::ratio, 0.01, 12, "Stem diameter at breast height (1.3 m)"},
                   {"crown_diameter", "m", Scale::ratio, 0.1, 60, "Mean width of the crown"}},
      .evidence = EvidenceModel::canopy,
      .body = {"crown_diameter", 0.5},
      .identification_reach = 200,
      .drawn_as = Solid::cone,
      .colour = "#2e7d32",
      .label_feature = "",
      .size_feature = "crown_diameter",
  });
}

}  // namespace waymark::inline landmarks
