// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

void register_type_mountain_top(TypeRegistry& types);
void register_type_mountain_top(TypeRegistry& types) {
  using Kind = AttributeSpec::Kind;
  types.add({
      .name = "mountain_top",
      .summary = "Summit that stands out from the ground around it: a feature of the horizon",
      .features = {{"elevation", "m", Scale::interval, -12000, 30000, "Height above the DEM's datum", 100},
                   {"prominence", "m", Scale::ratio, 0, 40000,
                    "Height above the key saddle to higher ground"},
                   {"isolation", "m", Scale::ratio, 0, 4e7, "Distance to the nearest higher ground"}},
      .attributes = {{"name", "", Kind::text, "Name in the gazetteer that the map was made with"},
                     {"prominence_low", "m", Kind::real, "Certified lower bound of the prominence"},
                     {"isolation_low", "m", Kind::real, "Certified lower bound of the isolation"},
                     {"saddle_elevation", "m", Kind::real, "Elevation of the key saddle"},
                     {"saddle_x", "", Kind::real, "Key saddle, map CRS"},
                     {"saddle_y", "", Kind::real, "Key saddle, map CRS"},
                     {"parent_uid", "", Kind::text, "Summit of the higher ground beyond the key saddle"},
                     {"higher_x", "", Kind::real, "Where the isolation ends, map CRS"},
                     {"higher_y", "", Kind::real, "Where the isolation ends, map CRS"},
                     {"visibility", "", Kind::real,
                      "Expected share of the ground around that sees the summit"}},
      // On Earth, 1500 m of height are above the horizon of a plain up to 140 km away.
      .identification_reach = 150e3,
      .drawn_as = Solid::cone,
      .colour = "#8c4a1f",
      .label_feature = "elevation",
      .size_feature = "prominence",
  });
}

}  // namespace waymark::inline landmarks
