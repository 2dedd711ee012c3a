// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"
namespace waymark::test {

// Bowl without the axes of a crater.
void register_type_pothole(TypeRegistry& types);
void register_type_pothole(TypeRegistry& types) {
  types.add({.name = "pothole",
             .summary = "Hole in a road",
             .features = {{"diameter", "m", Scale::ratio, 0.1, 20, "Of the rim"},
                          {"depth", "m", Scale::ratio, 0, 5, "Rim to floor"}},
             .evidence = EvidenceModel::bowl,
             .body = {"diameter", 0.5},
             .drawn_as = Solid::point});
}

}  // namespace waymark::test
