// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"
namespace waymark::test {

// Casts shadows like a rock, but is drawn and measured otherwise.
void register_type_haystack(TypeRegistry& types);
void register_type_haystack(TypeRegistry& types) {
  types.add({.name = "haystack",
             .summary = "Heap of hay",
             .features = {{"width", "m", Scale::ratio, 0.5, 20, "Across the heap"},
                          {"height", "m", Scale::ratio, 0.5, 20, "Of the heap"}},
             .evidence = EvidenceModel::shadow_caster,
             .body = {"width", 0.5},
             .drawn_as = Solid::cone});
}

}  // namespace waymark::test
