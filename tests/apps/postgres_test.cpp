// SPDX-License-Identifier: Apache-2.0
// Maps in PostgreSQL and PostGIS: the round trip, updates, several writers, and what is refused. The server
// is started by the test.
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <sstream>

#include "made_dem.hpp"
#include "made_flight.hpp"
#include "program.hpp"

namespace waymark::test {
namespace {

using testing::HasSubstr;

class Postgres : public testing::Test {
 protected:
  static inline const std::string kSite = WAYMARK_SOURCE_DIR "/tests/apps/postgres_site ";

  void SetUp() override {
    if (bash(kSite + "--available").code != 0)
      GTEST_SKIP() << "needs postgresql-15 and postgresql-15-postgis-3";
    bash("chmod 755 " + folder_.path().string());
    const Outcome started = bash(kSite + "start " + server_);
    ASSERT_EQ(started.code, 0) << started.err;
    running_ = true;
  }
  void TearDown() override {
    if (running_) bash(kSite + "stop " + server_);
  }

  std::string address(const std::string& rest = "", const std::string& database = "maps",
                      const std::string& user = "owner") const {
    return "pg:host=" + server_ + " dbname=" + database + " user=" + user + " " + rest;
  }
  std::string sql(const std::string& text, const std::string& database = "maps") const {
    const Outcome said = bash("psql -qtA -h " + server_ + " -U owner -d " + database + " -c \"" + text + '"');
    EXPECT_EQ(said.code, 0) << said.err;
    return said.out.substr(0, said.out.find_last_not_of('\n') + 1);
  }
  /// Rocks r<first> to r<last - 1> at random positions; each is observed once.
  std::string rocks(const std::string& name, int first, int last, double radius = .5,
                    const std::string& crs = "EPSG:32633") const {
    std::mt19937 random(static_cast<unsigned>(first) + 71);
    std::string rows = "uid,x,y,z,radius,height,position_sd\n";
    for (int i = first; i < last; ++i)
      rows += "r" + std::to_string(i) + ',' + std::to_string(double(random() % 100000) / 7) + ',' +
              std::to_string(double(random() % 100000) / 7) + ",3," + std::to_string(radius) + ",.2,.1\n";
    write_text(folder_ / (name + ".csv"), rows);
    const std::string map = folder_ / (name + ".gpkg");
    const Outcome made = waymark({"import", folder_ / (name + ".csv"), "-o", map, "--type", "rock",
                                  "--map-crs", crs, "--columns", "position_sd=position_sd"});
    EXPECT_EQ(made.code, 0) << made.err;
    return map;
  }
  static void expect_done(const Outcome& said) { EXPECT_EQ(said.code, 0) << said.err; }
  /// Returns a query of the numbers of rows of these tables, of a schema where it is named.
  static std::string row_count_query(const std::vector<std::string>& tables, const std::string& schema = "") {
    std::string query;
    for (const std::string& table : tables)
      query +=
          (query.empty() ? "" : " UNION ALL ") + ("SELECT '" + table + "', count(*) FROM ") + schema + table;
    return query;
  }
  static std::map<std::string, long> row_counts(const std::string& rows) {
    std::map<std::string, long> counts;
    std::istringstream lines(rows);
    for (std::string table, count; std::getline(lines, table, '|') && std::getline(lines, count);)
      counts[table] = std::stol(count);
    return counts;
  }
  /// Tables of a map without those of spatial indexes.
  static std::vector<std::string> tables_of(const std::string& map) {
    std::istringstream names(bash("sqlite3 " + map +
                                  " \"SELECT name FROM sqlite_master WHERE type = 'table' AND name NOT LIKE "
                                  "'rtree%'\"")
                                 .out);
    return {std::istream_iterator<std::string>(names), {}};
  }
  /// Expects that a map comes back with the same bytes, once SQLite has written both in its own order.
  void expect_round_trip(const std::string& map, const std::string& to) {
    expect_done(waymark({"export", map, to}));
    const std::string back = folder_ / "back.gpkg", compact = folder_ / "compact.gpkg";
    expect_done(waymark({"import", to, "-o", back}));
    expect_done(waymark({"validate", back}));
    expect_done(bash("rm -f " + compact + " " + compact + "2; sqlite3 " + map + " \"VACUUM INTO '" + compact +
                     "'\"; sqlite3 " + back + " \"VACUUM INTO '" + compact + "2'\""));
    EXPECT_EQ(bash("cmp " + compact + ' ' + compact + "2").out, "");
  }

  TempFolder folder_;
  std::string server_ = folder_ / "server";
  bool running_ = false;
};

TEST_F(Postgres, MapsComeBackWithTheSameBytes) {
  const std::string map = rocks("rocks", 0, 500);
  expect_round_trip(map, address("schema=rocks"));
  expect_round_trip(map, address("schema=rocks"));  // and once more: nothing is added
  expect_round_trip(rocks("mars", 0, 50, .5, "IAU_2015:49910"), address("schema=mars"));
  expect_round_trip(rocks("plain", 0, 50), address("", "plain"));  // a database without PostGIS
  EXPECT_EQ(sql("SELECT auth_name, auth_srid FROM spatial_ref_sys JOIN geometry_columns USING (srid) WHERE "
                "f_table_schema = 'mars' AND f_table_name = 'rock'"),
            "IAU_2015|49910");
  const std::string dem = make_dem(folder_ / "hills.tif", hills(256, 256));
  expect_done(waymark({"peaks", dem, "-o", folder_ / "peaks.gpkg"}));
  expect_round_trip(folder_ / "peaks.gpkg", address("schema=peaks"));
}

// Images, footprints, evidence, DEM tiles, crowns, stands, routes, hazards: the bytes of all come back, and
// every table that a map can have holds rows in one of these maps.
TEST_F(Postgres, EveryTableComesBack) {
  const auto site = simulate_flight(folder_.path(), {});
  const std::string source = WAYMARK_SOURCE_DIR, images = folder_ / "images.gpkg",
                    forest = folder_ / "forest.gpkg", hazards = folder_ / "hazards.gpkg",
                    route = folder_ / "route.gpkg", peaks = folder_ / "peaks.gpkg";
  expect_done(waymark({"peaks", make_dem(folder_ / "hills.tif", hills(256, 256)), "-o", peaks}));
  expect_done(waymark({"run", site / "job.json", "--with-dem", "-o", images}));
  expect_done(waymark(
      {"hazards", images, "--dem", site / "dem.tif", "-o", folder_ / "h.tif", "--polygons", hazards}));
  expect_done(waymark({"route", images, "--from=-20,-12", "--to", "20,12", "--sensor", "horizontal_laser",
                       "--hazards", "none", "--weight", "2", "-o", route}));
  expect_done(waymark({"simulate", source + "/sample_data/forest/scenario.json", "-o", folder_ / "forest"}));
  expect_done(waymark({"run", folder_ / "forest/job.json", "-o", forest}));
  expect_done(waymark({"inventory", forest, "--stands", folder_ / "forest/stands.geojson", "-o", forest}));
  std::map<std::string, long> rows;
  for (const std::string& map : {images, forest, hazards, route, peaks}) {
    const std::string schema = std::filesystem::path(map).stem();
    expect_round_trip(map, address("schema=" + schema));
    expect_round_trip(map, address("schema=" + schema));  // and once more: nothing is added or lost
    const std::vector<std::string> tables = tables_of(map);
    const auto of_map = row_counts(bash("sqlite3 " + map + " \"" + row_count_query(tables) + '"').out);
    EXPECT_EQ(of_map.size(), tables.size());
    EXPECT_EQ(row_counts(sql(row_count_query(tables, schema + "."))), of_map) << schema;
    for (const auto& [table, count] : of_map) rows[table] = std::max(rows[table], count);
  }
  for (const auto& [table, count] : rows) {
    const bool may_be_empty =
        table == "waymark_moved" || table.starts_with("crater") || table == "mountain_top_observation";
    EXPECT_TRUE(count > 0 || may_be_empty) << table;
  }
  for (const char* table : {"image", "observation", "rock", "rock_observation", "run", "dem",
                            "gpkg_tile_matrix", "gpkg_2d_gridded_tile_ancillary", "waymark_layer", "crown",
                            "stand", "stand_tree", "hazard", "route", "route_station", "tree", "survey"})
    EXPECT_TRUE(rows.contains(table)) << table;
  EXPECT_EQ(sql("SELECT count(*) FILTER (WHERE ST_IsValid(geom)) = count(*) FROM hazards.hazard"), "t");
  EXPECT_EQ(sql("SELECT DISTINCT ST_GeometryType(geom) FROM route.route"), "ST_MultiLineString");
}

// The tiles of another DEM replace the old ones, with the matrix that places them.
TEST_F(Postgres, TheDemOfAnUpdateIsWhole) {
  const auto peaks = [&](const std::string& name, int side) {
    const std::string dem = make_dem(folder_ / (name + ".tif"), hills(side, side)),
                      map = folder_ / (name + ".gpkg");
    expect_done(waymark({"peaks", dem, "--with-dem", "-o", map}));
    return map;
  };
  const std::string small = peaks("small", 256), large = peaks("large", 700);
  expect_done(waymark({"export", small, address()}));
  expect_done(waymark({"export", large, address()}));
  const std::string back = folder_ / "back.gpkg";
  expect_done(waymark({"import", address(), "-o", back}));
  expect_done(waymark({"validate", back}));
  for (const std::string table : {"dem", "gpkg_tile_matrix", "gpkg_tile_matrix_set",
                                  "gpkg_2d_gridded_coverage_ancillary", "gpkg_2d_gridded_tile_ancillary"}) {
    const std::string select = " 'SELECT * FROM " + table + "' | sed 's/|20[0-9-]*T.*//' | sha256sum";
    EXPECT_EQ(bash("sqlite3 " + back + select).out, bash("sqlite3 " + large + select).out) << table;
  }
}

TEST_F(Postgres, LandmarksOfTheSameUidAreReplacedAndRunsAreKept) {
  expect_done(waymark({"export", rocks("old", 0, 20, .5), address()}));
  expect_done(waymark({"export", rocks("new", 10, 30, .8), address()}));
  EXPECT_EQ(sql("SELECT count(*), count(*) FILTER (WHERE radius = .8), count(DISTINCT id) FROM waymark.rock"),
            "30|20|30");
  EXPECT_EQ(sql("SELECT count(*) FROM waymark.run"), "2");
  EXPECT_EQ(sql("SELECT count(*) FROM waymark.landmark"), "30");
  const std::string both = folder_ / "both.gpkg";
  expect_done(waymark({"import", address(), "-o", both}));
  expect_done(waymark({"validate", both}));
}

TEST_F(Postgres, FourWritersLeaveTheLandmarksOfAll) {
  std::string line = "export WAYMARK;";
  for (int i = 0; i < 4; ++i)
    line += " $WAYMARK export " + rocks("part" + std::to_string(i), 50 * i, 50 * i + 100) + " '" + address() +
            "' & pids+=($!);";
  const Outcome said = bash(line + " for pid in ${pids[@]}; do wait $pid || exit 1; done");
  expect_done(said);
  EXPECT_EQ(sql("SELECT count(*), count(DISTINCT uid), count(DISTINCT id) FROM waymark.rock"), "250|250|250");
  EXPECT_EQ(sql("SELECT count(*) FROM waymark.run"), "4");
}

TEST_F(Postgres, BadInputChangesNothing) {
  const auto expect_refusal = [&](const std::vector<std::string>& words, int code, const std::string& text) {
    const Outcome said = waymark(words);
    EXPECT_EQ(said.code, code) << text;
    EXPECT_THAT(said.err, HasSubstr(text));
  };
  const std::string map = rocks("rocks", 0, 20), back = folder_ / "back.gpkg";
  expect_refusal({"export", map, "pg:host=/nowhere dbname=x"}, 1, "cannot connect to PostgreSQL");
  expect_refusal({"export", map, address("", "absent")}, 1, "\"absent\" does not exist");
  expect_refusal({"export", map, address("", "maps", "guest")}, 1, "permission denied");
  expect_refusal({"export", map, address("schema=pg_x")}, 2, "is not a schema for a map");
  expect_refusal({"export", map, address(), "--type", "rock"}, 2, "a database stores the whole map");
  expect_refusal({"import", address("schema=absent"), "-o", back}, 1, "there is no such schema");
  expect_refusal({"import", address("schema=public"), "-o", back}, 1, "holds no map");
  EXPECT_FALSE(std::filesystem::exists(back));

  expect_done(waymark({"export", map, address()}));
  expect_refusal({"export", rocks("moon", 0, 5, .5, "IAU_2015:30110"), address()}, 1, "other landmark types");
  sql("UPDATE waymark.waymark_postgres SET version = 99");
  expect_refusal({"export", map, address()}, 1, "the schema has version 99");
  expect_refusal({"import", address(), "-o", back}, 1, "the schema has version 99");
  sql("UPDATE waymark.waymark_postgres SET version = 1");
  sql("UPDATE waymark.waymark_definition SET sql = 'ATTACH DATABASE ''/tmp/x'' AS x' WHERE position = 3");
  expect_refusal({"import", address(), "-o", back}, 1, "holds a statement that no map has");
  EXPECT_FALSE(std::filesystem::exists(back));
  EXPECT_EQ(sql("SELECT count(*) FROM waymark.rock"), "20");
}

TEST_F(Postgres, AConnectionThatIsCutLeavesTheOldMap) {
  expect_done(waymark({"export", rocks("old", 0, 20), address()}));
  const std::string large = rocks("large", 10, 60'000);
  // The writer holds its lock in the middle of the transaction until it is cut.
  const Outcome said = bash("export WAYMARK; $WAYMARK export " + large + " '" + address() + R"(' & writer=$!
for i in $(seq 500); do
  cut=$(psql -qtA -h )" + server_ +
                            R"( -U owner -d maps -c "SELECT pg_terminate_backend(pid) FROM pg_stat_activity
    WHERE pid <> pg_backend_pid() AND state IN ('active', 'idle in transaction') AND backend_type = 'client backend'")
  [ -z "$cut" ] || break
done
wait $writer)");
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, HasSubstr("nothing was changed"));
  EXPECT_EQ(sql("SELECT count(*) FROM waymark.rock"), "20");
}

}  // namespace
}  // namespace waymark::test
