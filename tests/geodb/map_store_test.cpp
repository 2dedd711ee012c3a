// SPDX-License-Identifier: Apache-2.0
// Opening of maps: rejected files, migration, and reading without changes.
#include "geodb/map_store.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include <fstream>

#include "core/error.hpp"
#include "geodb/geopackage/migrations.hpp"
#include "geodb/map_editor.hpp"
#include "geodb/sqlite/sqlite.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "tests/geodb/map_scenes.hpp"

namespace waymark::test {
using namespace geodb;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string message_of_opening(const std::filesystem::path& path) {
  try {
    MapStore::open(path);
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr(path.string()));
    return error.what();
  }
  return "opened";
}

TEST(OpenMap, RefusesWhatIsNotAMap) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of_opening(folder / "missing.gpkg"), HasSubstr("there is no such map"));
  EXPECT_THAT(message_of_opening(folder.path()), HasSubstr("this is not a file"));
  std::ofstream(folder / "empty.gpkg");
  EXPECT_THAT(message_of_opening(folder / "empty.gpkg"), HasSubstr("this file is empty"));
  std::ofstream(folder / "text.gpkg") << std::string(5000, 'x');
  EXPECT_THAT(message_of_opening(folder / "text.gpkg"), HasSubstr("this is not a GeoPackage"));
  sqlite::Database(folder / "other.gpkg", sqlite::OpenMode::create).execute("CREATE TABLE t (x)");
  EXPECT_THAT(message_of_opening(folder / "other.gpkg"), HasSubstr("this is not a GeoPackage"));
}

TEST(OpenMap, RefusesForeignGeoPackages) {
  const TemporaryFolder folder;
  std::ofstream(folder / "points.csv") << "x,y\n1,2\n";
  const auto made =
      run_program("ogr2ogr -f GPKG " + (folder / "points.gpkg").string() + " " +
                  (folder / "points.csv").string() + " -oo X_POSSIBLE_NAMES=x -oo Y_POSSIBLE_NAMES=y");
  ASSERT_EQ(made.exit_code, 0) << made.output;
  EXPECT_THAT(message_of_opening(folder / "points.gpkg"), HasSubstr("this GeoPackage is not a Waymark map"));
}

TEST(OpenMap, RefusesNewerMaps) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  execute_sql(folder / "map.gpkg", "INSERT INTO waymark_schema VALUES (99, 'from the future')");
  EXPECT_THAT(message_of_opening(folder / "map.gpkg"),
              HasSubstr("schema version 99, this program supports up to 3"));
}

TEST(OpenMap, RefusesATruncatedMap) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  std::filesystem::resize_file(folder / "map.gpkg", 9000);
  EXPECT_THAT(message_of_opening(folder / "map.gpkg"), HasSubstr("this map is damaged"));
}

/// Creates the old map of tests/geodb/version_1.sql (see make_version_1.sh).
void make_version_1(const std::filesystem::path& path) {
  sqlite::Database(path, sqlite::OpenMode::create)
      .execute(file_bytes(WAYMARK_SOURCE_DIR "/tests/geodb/version_1.sql"));
}

TEST(Migration, AnOldMapIsReadWithoutChangingIt) {
  const TemporaryFolder folder;
  make_version_1(folder / "old.gpkg");
  const std::string before = file_bytes(folder / "old.gpkg");
  const MapStore map = MapStore::open(folder / "old.gpkg");
  EXPECT_EQ(map.schema_version(), 1);
  EXPECT_EQ(map.count("lamp_post"), 3);
  ASSERT_EQ(map.runs().size(), 1u);
  EXPECT_EQ(map.runs()[0].report_json, "{}");
  EXPECT_EQ(map.images().at(0).taken_utc, "");
  EXPECT_THAT(validate_map(folder / "old.gpkg"), IsEmpty());
  EXPECT_TRUE(file_bytes(folder / "old.gpkg") == before);
}

TEST(Migration, AnEditorMigratesInPlace) {
  const TemporaryFolder folder;
  make_version_1(folder / "old.gpkg");
  MapEditor::open(folder / "old.gpkg").remove("lp-1");
  const MapStore map = MapStore::open(folder / "old.gpkg");
  EXPECT_EQ(map.schema_version(), 3);
  EXPECT_EQ(map.count(), 2);
  EXPECT_EQ(run_program("/usr/bin/python3 -m osgeo_utils.samples.validate_gpkg -k --extra " +
                        (folder / "old.gpkg").string())
                .output,
            "");
}

TEST(Migration, WhatNobodyAssessedHasNoQualityAndMovesAreSeen) {
  const TemporaryFolder folder;
  const std::filesystem::path old = folder / "old.gpkg";
  make_version_1(old);
  execute_sql(old,
              "UPDATE lamp_post SET seen = 1, visible = 1, q_multiplicity = 1, quality = 1, height_q = NULL,"
              " height_sd = NULL, observations = 1 WHERE uid = 'lp-0'");  // as versions 1 and 2 stored it
  EXPECT_THAT(validate_map(old), IsEmpty());
  EXPECT_EQ(MapStore::open(old).query({.min_quality = 0.1}).size(), 2u);
  MapEditor::open(old).remove("lp-1");  // migrates in place
  EXPECT_EQ(
      query_text(
          old, "SELECT group_concat(coalesce(quality, 'none')) FROM (SELECT * FROM lamp_post ORDER BY uid)"),
      "none,0.675");
  execute_sql(old, "UPDATE lamp_post SET geom = (SELECT geom FROM lamp_post WHERE uid = 'lp-2')");
  EXPECT_EQ(query_text(old, "SELECT count(*) FROM waymark_moved"), "1");  // lp-2 did not move
}

// Built-in types get their own declaration; others what drawing and size meant before.
TEST(Migration, TypesDeclareHowTheyAreSeen) {
  const TemporaryFolder folder;
  const std::filesystem::path old = folder / "old.gpkg";
  make_version_1(old);
  execute_sql(old, R"(
      INSERT INTO waymark_type VALUES (2, 'mountain_top', '', 'cone', '#000000', '', ''),
          (3, 'sinkhole', '', 'bowl', '#000000', '', 'diameter');
      INSERT INTO waymark_feature (type, position, name, unit, scale, reference, summary)
          VALUES ('sinkhole', 0, 'diameter', 'm', 'ratio', 0, '');)");
  const sqlite::Database database(old, sqlite::OpenMode::update);
  migrate(database);
  sqlite::Statement row = database.prepare(
      "SELECT name, evidence, body_feature, radius_per_value, identification_reach FROM waymark_type ORDER "
      "BY id");
  std::vector<std::string> rows;
  while (row.step())
    rows.push_back(
        fmt::format("{} {} '{}' {} {}", row.text(0), row.text(1), row.text(2), row.real(3), row.real(4)));
  EXPECT_THAT(rows, ElementsAre("lamp_post none '' 1 100", "mountain_top none '' 1 150000",
                                "sinkhole bowl 'diameter' 0.5 100"));
}

TEST(Reading, VisitingGivesTheSameAsReadingAll) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  const MapStore map = MapStore::open(folder / "map.gpkg");
  std::vector<std::string> uids, sources;
  map.visit("lamp_post", [&](Landmark&& landmark) { uids.push_back(landmark.uid); });
  map.visit_observations([&](Observation&& o) { sources.push_back(o.source + o.landmark_uid + o.rejected); });
  std::vector<std::string> all_uids, all_sources;
  for (const Landmark& landmark : map.query({})) all_uids.push_back(landmark.uid);
  for (const Observation& o : map.observations())
    all_sources.push_back(o.source + o.landmark_uid + o.rejected);
  EXPECT_EQ(uids, all_uids);
  EXPECT_EQ(sources, all_sources);
  EXPECT_THROW(map.visit("rock", [](Landmark&&) {}), Error);
}

void use_it(const MapStore& map) {
  map.query({.nearest = MapQuery::NearestK{450'000, 5'050'000, 5}});
  map.observations();
  map.runs();
}

TEST(Reading, LeavesNoTrace) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  for (const char* mode : {"DELETE", "WAL"}) {
    execute_sql(folder / "map.gpkg", std::string("PRAGMA journal_mode = ") + mode);
    const std::string before = file_bytes(folder / "map.gpkg");
    const auto time = std::filesystem::last_write_time(folder / "map.gpkg");
    use_it(MapStore::open(folder / "map.gpkg"));
    EXPECT_THAT(validate_map(folder / "map.gpkg"), IsEmpty());
    EXPECT_TRUE(file_bytes(folder / "map.gpkg") == before) << mode;
    EXPECT_EQ(std::filesystem::last_write_time(folder / "map.gpkg"), time);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << mode;
  }
}

TEST(Reading, IncludesTheWriteAheadLog) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  const sqlite::Database other(folder / "map.gpkg", sqlite::OpenMode::update);
  other.execute("PRAGMA journal_mode = WAL; DELETE FROM lamp_post WHERE uid = 'lp-9'");
  EXPECT_EQ(MapStore::open(folder / "map.gpkg").count(), 999);
}

TEST(MapStore, VisitsABoxInTheOrderOfRows) {
  TemporaryFolder folder;
  const MapContents contents = scattered({.landmarks = 3000, .with_evidence = 400});
  write_map(folder / "map.gpkg", contents);
  const MapStore map = MapStore::open(folder / "map.gpkg");
  const std::string type = contents.types[0].name;
  const Eigen::Vector3d& corner = contents.landmarks[7].position.xyz;  // a landmark on the edge
  for (const MapQuery::Box& box :
       {MapQuery::Box{corner.x(), corner.y(), corner.x() + 30'000, corner.y() + 20'000},
        MapQuery::Box{0, 0, 1e7, 1e7}, MapQuery::Box{0, 0, 1, 1}}) {
    const auto inside = [&](const Eigen::Vector3d& at) {
      return at.x() >= box.min_x && at.x() <= box.max_x && at.y() >= box.min_y && at.y() <= box.max_y;
    };
    std::vector<std::string> expected, found, seen, expected_seen;
    std::set<std::string> there;
    map.visit(type, [&](Landmark&& l) {
      if (inside(l.position.xyz)) expected.push_back(l.uid);
    });
    map.visit(type, box, [&](Landmark&& l) { found.push_back(l.uid); });
    EXPECT_EQ(found, expected);
    there.insert(found.begin(), found.end());
    map.visit_observations([&](Observation&& o) {
      if (o.rejected.empty() && there.contains(o.landmark_uid)) expected_seen.push_back(o.landmark_uid);
    });
    map.visit_observations(type, box, [&](Observation&& o) {
      if (there.contains(o.landmark_uid)) seen.push_back(o.landmark_uid);
    });
    EXPECT_EQ(seen, expected_seen);
  }
}

}  // namespace
}  // namespace waymark::test
