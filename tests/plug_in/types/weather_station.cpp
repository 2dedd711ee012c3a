// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"
namespace waymark::test {

void register_type_weather_station(TypeRegistry& types);
void register_type_weather_station(TypeRegistry& types) {
  types.add({.name = "weather_station",
             .summary = "Mast with instruments on a summit",
             .features = {{"height", "m", Scale::ratio, 1, 100, "Of the mast"}},
             .evidence = EvidenceModel::upright,
             .drawn_as = Solid::cylinder});
}

}  // namespace waymark::test
