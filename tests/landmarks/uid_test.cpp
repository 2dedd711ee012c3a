// SPDX-License-Identifier: Apache-2.0
#include "landmarks/uid.hpp"

#include <gmock/gmock.h>

#include <optional>
#include <set>

#include "landmarks/uid_index.hpp"

namespace waymark::test {
namespace {

using ::testing::MatchesRegex;

const LandmarkType kTop{.name = "mountain_top", .summary = {}, .features = {}};
const LandmarkType kRock{.name = "rock", .summary = {}, .features = {}};

TEST(Uid, BeginsWithTheTypesInitials) {
  const Crs crs = Crs::from_text("EPSG:4326");
  EXPECT_THAT(make_uid(kTop, crs, {{8, 46, 0}}), MatchesRegex("mt-[0-9a-hjkmnp-tv-z]+"));
  EXPECT_THAT(make_uid(kRock, crs, {{8, 46, 0}}), MatchesRegex("ro-[0-9a-hjkmnp-tv-z]+"));
  EXPECT_EQ(make_uid(kRock, crs, {{8, 46, 0}}).size(), 16u);
}

TEST(Uid, NeverChanges) {  // existing maps contain these uids
  EXPECT_EQ(make_uid(kTop, Crs::from_text("EPSG:4326"), {{-70.011, -32.653, 6929}}), "mt-6p5ge7fc9s4mc");
}

TEST(Uid, DependsOnTypeCrsAndPositionAlone) {
  const Crs earth_crs = Crs::from_text("EPSG:4326"), mars_crs = Crs::from_text("IAU_2015:49900");
  const std::string uid = make_uid(kRock, earth_crs, {{8, 46, 0}});
  EXPECT_EQ(make_uid(kRock, earth_crs, {{8, 46, 99}}), uid) << "heights are refined";
  EXPECT_EQ(make_uid(kRock, earth_crs, {{8 + 1e-9, 46, 0}}), uid) << "less than the rounding";
  EXPECT_NE(make_uid(kRock, earth_crs, {{8 + 1e-6, 46, 0}}), uid);
  EXPECT_NE(make_uid(kRock, mars_crs, {{8, 46, 0}}), uid);
  EXPECT_NE(make_uid(kTop, earth_crs, {{8, 46, 0}}).substr(3), uid.substr(3));
}

TEST(Uid, LongitudesAreEqualModuloATurn) {
  const Crs crs = Crs::from_text("IAU_2015:49900");
  EXPECT_EQ(make_uid(kTop, crs, {{350, 10, 0}}), make_uid(kTop, crs, {{-10, 10, 0}}));
  EXPECT_EQ(make_uid(kTop, crs, {{180, 10, 0}}), make_uid(kTop, crs, {{-180, 10, 0}}));
}

TEST(Uid, RoundsToACentimetreOnAPlane) {
  const Crs utm = Crs::from_text("EPSG:32632");
  EXPECT_EQ(make_uid(kTop, utm, {{400000.001, 5e6, 0}}), make_uid(kTop, utm, {{400000, 5e6, 0}}));
  EXPECT_NE(make_uid(kTop, utm, {{400000.02, 5e6, 0}}), make_uid(kTop, utm, {{400000, 5e6, 0}}));
}

TEST(Uid, NeighbouringCellsHaveDifferentUids) {
  const Crs crs = Crs::from_text("EPSG:4326");
  std::set<std::string> uids;
  for (int row = 0; row < 200; ++row)
    for (int column = 0; column < 200; ++column)
      uids.insert(make_uid(kTop, crs, {{8 + column / 3600.0, 46 - row / 3600.0, 0}}));
  EXPECT_EQ(uids.size(), 40000u);
}

TEST(AssignUids, NumbersThoseAtOnePosition) {
  TypeRegistry types;
  types.add(kRock);
  std::vector<Landmark> rocks(4);
  rocks[3].position = {{1, 0, 0}};
  assign_uids(types, Crs::local(), rocks);
  EXPECT_EQ(rocks[1].uid, rocks[0].uid + "-2");
  EXPECT_EQ(rocks[2].uid, rocks[0].uid + "-3");
  EXPECT_NE(rocks[3].uid, rocks[0].uid);
}

TEST(UidIndex, FindsTheFirstOfEachUid) {
  std::vector<Landmark> landmarks(1000);
  for (std::size_t i = 0; i < landmarks.size(); ++i) landmarks[i].uid = "tr-" + std::to_string(i % 900);
  const UidIndex all(landmarks);
  std::vector<std::uint32_t> some;
  for (std::uint32_t i = 999; i >= 950; --i) some.push_back(i);
  const UidIndex few(landmarks, some), none(landmarks, std::span<const std::uint32_t>{});
  for (std::uint32_t i = 0; i < 900; ++i) {
    const std::string uid = "tr-" + std::to_string(i);
    EXPECT_EQ(all.find(uid), i);
    EXPECT_EQ(few.find(uid), i >= 50 && i < 100 ? std::optional(99 - i) : std::nullopt) << i;
    EXPECT_EQ(none.find(uid), std::nullopt);
  }
  EXPECT_EQ(all.find("tr-900"), std::nullopt);
  EXPECT_EQ(UidIndex(std::span<const Landmark>{}).find(""), std::nullopt);
}

}  // namespace
}  // namespace waymark::test
