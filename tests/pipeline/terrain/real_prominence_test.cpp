// SPDX-License-Identifier: Apache-2.0
// Zero differences from two independent programs (see ../shared/data/dem/README.md).
#include "pipeline/terrain/prominence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/pipeline/terrain/shared_data.hpp"

namespace waymark::test {
namespace {

struct Expected {
  const char* file;
  std::vector<std::string> dems;
  NodataPolicy policy = NodataPolicy::ocean;
};

void PrintTo(const Expected& expected, std::ostream* out) {
  *out << expected.file;
}

class ProminenceOfRealGround : public ::testing::TestWithParam<Expected> {};

// Elevation and prominence of every summit of at least 20 m, as a multiset.
TEST_P(ProminenceOfRealGround, HasNoDifferenceFromTheReference) {
  SKIP_WITHOUT_DEM_DATA();
  const Expected& expected = GetParam();
  std::multiset<std::pair<double, double>> theirs, ours;
  for (const auto& row : read_rows(dem_data() / "expected" / expected.file))
    theirs.emplace(std::stod(row.at(2)), std::stod(row.at(5)));
  ASSERT_GT(theirs.size(), 500u);
  const auto dem = open_dem(expected.dems, expected.policy);
  for (const pipeline::Summit& s : survey(*dem, 512, 20)) ours.emplace(s.height, s.prominence);
  std::vector<std::pair<double, double>> missing, extra;
  std::ranges::set_difference(theirs, ours, std::back_inserter(missing));
  std::ranges::set_difference(ours, theirs, std::back_inserter(extra));
  EXPECT_EQ(missing.size(), 0u) << "first: " << (missing.empty() ? 0 : missing[0].first);
  EXPECT_EQ(extra.size(), 0u) << "first: " << (extra.empty() ? 0 : extra[0].first);
  ::testing::Test::RecordProperty("summits", static_cast<int>(ours.size()));
}

INSTANTIATE_TEST_SUITE_P(
    Tiles, ProminenceOfRealGround,
    ::testing::Values(Expected{"prominence20_S33W071.txt", {"earth/S33W071.tif"}},
                      Expected{"prominence20_N42E001.txt", {"earth/N42E001.tif"}},
                      Expected{"prominence20_N46E008.txt", {"earth/N46E008.tif"}},
                      Expected{"prominence20_N46E008_filled.txt", {"earth/N46E008.tif"}, NodataPolicy::fill},
                      Expected{"prominence20_N48W125.txt", {"earth/N48W125_1arcsec.tif"}},
                      Expected{"prominence20_N41-42E001.txt", {"earth/N41E001.tif", "earth/N42E001.tif"}},
                      Expected{"prominence20_N49W124-123.txt", {"earth/N49W124.tif", "earth/N49W123.tif"}}),
    [](const auto& test) {
      std::string name = test.param.file;
      std::ranges::replace_if(
          name, [](char c) { return !std::isalnum(c); }, '_');
      return name;
    });

std::map<std::int64_t, pipeline::Summit> by_cell(const std::vector<pipeline::Summit>& summits) {
  std::map<std::int64_t, pipeline::Summit> map;
  for (const pipeline::Summit& s : summits) map[s.cell] = s;
  return map;
}

// Summit by summit: cell, prominence, key saddle, and the certified bound from the highest open contact.
void expect_table(const char* table, const DemSource& dem, double least, const char* x, const char* y,
                  bool compare_bounds) {
  const auto summits = by_cell(survey(dem, 512, least));
  std::size_t compared = 0, saddle_elsewhere = 0;
  for (auto& row : read_table(dem_data() / "expected" / table)) {
    const double prominence = std::stod(row["prom"]);
    if (prominence <= 0) continue;
    const std::int64_t cell = cell_at(dem.geometry(), std::stod(row[x]), std::stod(row[y]));
    ASSERT_TRUE(summits.contains(cell)) << row[y] << " " << row[x] << " elevation " << row["elev"];
    const pipeline::Summit& s = summits.at(cell);
    EXPECT_EQ(s.height, std::stod(row["elev"]));
    EXPECT_EQ(s.prominence, prominence);
    ASSERT_EQ(s.saddle < 0, row["col_elev"].empty()) << row["elev"];
    double floor = 0;
    if (s.saddle >= 0) {
      EXPECT_EQ(s.saddle_height, std::stod(row["col_elev"]));
      floor = s.saddle_height;
      const std::string col_x = std::string("col_") + x, col_y = std::string("col_") + y;
      saddle_elsewhere += s.saddle != cell_at(dem.geometry(), std::stod(row[col_x]), std::stod(row[col_y]));
    }
    const double open = row["open"] == "1" ? std::stod(row["open_elev"]) : kNoHeight;
    if (compare_bounds) {
      EXPECT_EQ(s.prominence_low, s.height - std::max(floor, open)) << row["elev"];
    }
    ++compared;
  }
  EXPECT_EQ(compared, summits.size());
  ::testing::Test::RecordProperty("compared", static_cast<int>(compared));
  ::testing::Test::RecordProperty("saddle_elsewhere", static_cast<int>(saddle_elsewhere));
  EXPECT_LE(saddle_elsewhere, compared / 20) << "saddles of equal height may differ, but rarely do";
}

TEST(ProminenceTables, Aconcagua) {
  SKIP_WITHOUT_DEM_DATA();
  const auto dem = open_dem({"earth/S33W071.tif"}, NodataPolicy::unknown);
  expect_table("S33W071_all_maxima.csv", *dem, 0, "lon", "lat", true);
}

TEST(ProminenceTables, BigTujunga) {
  SKIP_WITHOUT_DEM_DATA();
  const auto dem = open_dem({"earth/bigtujunga.tif"}, NodataPolicy::unknown);
  expect_table("bigtujunga.csv", *dem, 20, "lon", "lat", true);
}

TEST(ProminenceTables, MarsWithWrap) {
  SKIP_WITHOUT_DEM_DATA();
  const auto dem = open_dem({"mars/mars_mola_4ppd.tif"});
  ASSERT_TRUE(dem->geometry().wraps);
  ASSERT_TRUE(dem->geometry().north_pole && dem->geometry().south_pole);
  expect_table("mars_mola_4ppd.csv", *dem, 500, "lon", "lat", true);
}

// Published prominences of Alpine summits. What is published must lie inside the certified interval of the
// DEM, but for the error of the DEM itself: its summits are lower than the real ones and its saddles higher
// or lower.
TEST(PublishedProminence, LiesInsideTheCertifiedInterval) {
  SKIP_WITHOUT_DEM_DATA();
  const auto dem = open_dem({"earth/N46E008.tif"}, NodataPolicy::fill);
  const auto summits = survey(*dem, 512, 0);
  const Geodesic geodesic(earth());
  int published = 0, matched = 0, inside = 0, within_50 = 0, within_100 = 0;
  std::vector<double> differences;
  for (auto& row : read_table(dem_data() / "truth_n46e008.csv")) {
    ++published;
    const double lon = std::stod(row["lon"]), lat = std::stod(row["lat"]);
    const double prominence = std::stod(row["prominence_m"]), elevation = std::stod(row["elevation_m"]);
    const pipeline::Summit* best = nullptr;
    for (const pipeline::Summit& s : summits) {
      const double x = dem->geometry().where.x(static_cast<double>(s.cell % dem->geometry().columns));
      const double y = dem->geometry().where.y(static_cast<double>(s.cell / dem->geometry().columns));
      if (std::abs(y - lat) > 0.006 || std::abs(x - lon) > 0.009) continue;
      if (geodesic.distance({x, y}, {lon, lat}) > 500 || std::abs(s.height - elevation) > 150) continue;
      if (!best || s.prominence > best->prominence) best = &s;
    }
    if (!best) continue;
    ++matched;
    const double tolerance =
        50;  // a 90 m DEM of the Alps: summits cut off, narrow saddles too high or too low
    inside += prominence >= best->prominence_low - tolerance && prominence <= best->prominence + tolerance;
    differences.push_back(best->prominence - prominence);
    within_50 += std::abs(differences.back()) <= 50;
    within_100 += std::abs(differences.back()) <= 100;
  }
  ASSERT_EQ(published, 135);
  std::ranges::sort(differences);
  ::testing::Test::RecordProperty("matched", matched);
  ::testing::Test::RecordProperty("inside_certified_interval", inside);
  ::testing::Test::RecordProperty("within_50_m", within_50);
  ::testing::Test::RecordProperty("within_100_m", within_100);
  std::cout << matched << " of 135 matched; median difference " << differences[differences.size() / 2]
            << " m; " << within_50 << " within 50 m, " << within_100 << " within 100 m; " << inside
            << " inside the certified interval (50 m for the DEM itself)\n";
  EXPECT_GE(matched, 120);
  EXPECT_GE(within_100, matched * 3 / 4);
  EXPECT_GE(inside, matched * 2 / 3);
}

}  // namespace
}  // namespace waymark::test
