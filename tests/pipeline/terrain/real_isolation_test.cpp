// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/isolation.hpp"

#include <gtest/gtest.h>

#include "tests/pipeline/terrain/shared_data.hpp"

namespace waymark::test {
namespace {

// Against an independent exact program: the same cell, or one at the same distance, and within 0.5 % of its
// metres (it measures on a sphere).
void expect_table(const char* table, const DemSource& dem, double least,
                  const pipeline::IsolationOptions& options, const char* x = "lon", const char* y = "lat") {
  std::map<std::int64_t, std::size_t> index;
  const auto summits = survey(dem, 512, least);
  for (std::size_t i = 0; i < summits.size(); ++i) index[summits[i].cell] = i;
  const auto isolations = isolation_of(summits, dem, options);
  int same_cell = 0, same_distance = 0, compared = 0;
  for (auto& row : read_table(dem_data() / "expected" / table)) {
    if (std::stod(row["prom"]) <= 0) continue;
    const auto found = index.find(cell_at(dem.geometry(), std::stod(row[x]), std::stod(row[y])));
    ASSERT_NE(found, index.end()) << row["elev"];
    const pipeline::Isolation& ours = isolations[found->second];
    const double theirs = std::stod(row["iso_m"]);
    ASSERT_EQ(ours.metres.has_value(), theirs >= 0) << row["elev"];
    if (!ours.metres) continue;
    ++compared;
    EXPECT_NEAR(*ours.metres, theirs, 0.005 * theirs + 0.06) << row["elev"];
    const auto end = cell_at(dem.geometry(), std::stod(row[std::string("ilp_") + x]),
                             std::stod(row[std::string("ilp_") + y]));
    const auto ours_end = dem.geometry().index(std::lround(ours.higher.column), std::lround(ours.higher.row));
    if (end == ours_end)
      ++same_cell;
    else
      same_distance += std::abs(*ours.metres - theirs) <= 0.0035 * theirs + 0.06;
  }
  ::testing::Test::RecordProperty("same_cell", same_cell);
  std::cout << compared << " compared: " << same_cell << " end at the same cell, " << same_distance
            << " at another as far\n";
  EXPECT_EQ(same_cell + same_distance, compared);
  EXPECT_GE(same_cell, compared * 95 / 100);
}

TEST(IsolationTables, AllMaximaOfAconcagua) {
  SKIP_WITHOUT_DEM_DATA();
  expect_table("S33W071_all_maxima.csv", *open_dem({"earth/S33W071.tif"}), 0, {});
}

TEST(IsolationTables, BigTujungaInUtm) {
  SKIP_WITHOUT_DEM_DATA();
  const auto dem = open_dem({"earth/bigtujunga.tif"});
  expect_table("bigtujunga.csv", *dem, 20, {.distance = pipeline::DistanceKind::planar});
  expect_table("bigtujunga.csv", *dem, 20, {});
}

TEST(IsolationTables, MarsRoundTheGlobe) {
  SKIP_WITHOUT_DEM_DATA();
  expect_table("mars_mola_4ppd.csv", *open_dem({"mars/mars_mola_4ppd.tif"}), 500, {});
}

// The other program misses summits at the right and bottom edges; those it has must agree.
TEST(IsolationTables, HalfAKilometreOnAconcagua) {
  SKIP_WITHOUT_DEM_DATA();
  const auto dem = open_dem({"earth/S33W071.tif"});
  const auto summits = survey(*dem, 512, 0);
  const auto isolations = isolation_of(summits, *dem);
  std::map<std::int64_t, double> ours;
  int ours_500 = 0;
  for (std::size_t i = 0; i < summits.size(); ++i) {
    if (isolations[i].metres) ours[summits[i].cell] = *isolations[i].metres / 1000;
    ours_500 += !isolations[i].metres || *isolations[i].metres >= 500;
  }
  int agree = 0, listed = 0;
  for (const auto& row : read_rows(dem_data() / "expected/isolation500m_S33W071.txt")) {
    ++listed;
    const auto found = ours.find(cell_at(dem->geometry(), std::stod(row[1]), std::stod(row[0])));
    agree += found != ours.end() && std::abs(found->second - std::stod(row[5])) <= 0.005 * found->second;
  }
  std::cout << listed << " listed, " << agree << " agree within 0.5 %; we find " << ours_500 << "\n";
  EXPECT_GE(agree, listed * 95 / 100);
  EXPECT_GE(ours_500, listed);
}

}  // namespace
}  // namespace waymark::test
