// SPDX-License-Identifier: Apache-2.0
// Maps of strangers: views and triggers without end, values of another kind, errors that a copy would
// inherit.
#include <gmock/gmock.h>

#include <fstream>

#include "core/error.hpp"
#include "geodb/map_editor.hpp"
#include "geodb/map_store.hpp"
#include "geodb/sqlite/sqlite.hpp"
#include "geodb/update_map.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "tests/geodb/map_scenes.hpp"

namespace waymark::test {
using namespace geodb;
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr const char* kEndless = "WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c) ";

template <class Action>
std::string problem_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input) << error.what();
    return error.what();
  }
  return {};
}

class HostileFile : public testing::Test {
 protected:
  void SetUp() override { write_map(map_, scattered({.landmarks = 60})); }
  std::string refusal(const std::function<void()>& action) const {
    const std::string said = problem_of(action);
    EXPECT_THAT(said, HasSubstr(map_.string()));
    return said;
  }
  TemporaryFolder folder_;
  std::filesystem::path map_ = folder_ / "map.gpkg";
};

TEST_F(HostileFile, AViewInPlaceOfATableIsNotRead) {
  const std::string original = file_bytes(map_);
  for (const char* table :
       {"lamp_post", "observation", "image", "run", "gpkg_contents", "gpkg_geometry_columns", "waymark_type",
        "waymark_feature", "waymark_attribute", "lamp_post_observation"}) {
    std::ofstream(map_, std::ios::binary) << original;
    const std::string name(table), kept = name + "_kept";
    execute_sql(map_, "PRAGMA legacy_alter_table = ON; DROP VIEW landmark; ALTER TABLE " + name +
                          " RENAME TO " + kept + "; CREATE VIEW " + name + " AS " + kEndless +
                          "SELECT k.* FROM " + kept + " k, c");
    EXPECT_THAT(refusal([&] { MapStore::open(map_); }), HasSubstr("'" + name + "' is a view")) << table;
    EXPECT_THAT(refusal([&] { validate_map(map_); }), HasSubstr("is a view")) << table;
    EXPECT_THAT(refusal([&] { MapEditor::open(map_); }), HasSubstr("is a view")) << table;
  }
}

TEST_F(HostileFile, AVersionFromAnEndlessViewEnds) {
  execute_sql(map_, std::string("ALTER TABLE waymark_schema RENAME TO kept; CREATE VIEW waymark_schema AS ") +
                        kEndless + "SELECT n AS version, 'x' AS description FROM c");
  EXPECT_THAT(refusal([&] { MapStore::open(map_); }), StartsWith("a query takes far longer"));
}

TEST_F(HostileFile, AStatementWithoutEndIsInterrupted) {
  const sqlite::Database database(map_, sqlite::OpenMode::read);
  EXPECT_THAT(refusal([&] { database.integer(std::string(kEndless) + "SELECT count(*) FROM c"); }),
              StartsWith("a query takes far longer"));
  std::int64_t rows = 0;
  EXPECT_THAT(refusal([&] {
                sqlite::Statement row = database.prepare(std::string(kEndless) + "SELECT n FROM c");
                while (row.step()) {
                  if (++rows % 10'000 == 0) database.integer("SELECT 1");  // does not reset the count
                }
              }),
              StartsWith("a query takes far longer"));
  EXPECT_GT(rows, 100'000);
  EXPECT_LT(rows, 20'000'000);
}

TEST_F(HostileFile, ManyShortExecutionsHaveNoLimit) {
  const sqlite::Database database(map_, sqlite::OpenMode::read);
  sqlite::Statement row = database.prepare("SELECT count(*) FROM lamp_post a, lamp_post b, lamp_post c");
  for (int i = 0; i < 30; ++i)  // a million instructions each: above the limit in all
    while (row.step()) EXPECT_EQ(row.integer(0), 216'000);
}

TEST_F(HostileFile, AnEndlessTriggerChangesNothing) {
  execute_sql(map_, std::string("CREATE TRIGGER t AFTER UPDATE ON lamp_post BEGIN INSERT INTO run (job) ") +
                        "SELECT n FROM (WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c) "
                        "SELECT n FROM c); END");
  const std::string before = query_text(map_, "SELECT group_concat(uid || height) FROM lamp_post");
  MapEditor editor = MapEditor::open(map_);
  Landmark landmark = editor.map().query({.limit = 1}).at(0);
  landmark.features[0].value += 1;
  EXPECT_FALSE(refusal([&] { editor.update(landmark); }).empty());
  EXPECT_EQ(query_text(map_, "SELECT group_concat(uid || height) FROM lamp_post"), before);
}

TEST_F(HostileFile, AForeignTriggerThatChangesRowsIsRefused) {
  for (const char* body :
       {"DELETE FROM lamp_post WHERE id <> NEW.id", "UPDATE lamp_post SET height = 99",
        "DELETE FROM observation", "INSERT INTO run (job) VALUES ('x')", "DELETE FROM waymark_type"}) {
    const auto copy = folder_ / "copy.gpkg";
    std::filesystem::copy_file(map_, copy, std::filesystem::copy_options::overwrite_existing);
    execute_sql(copy,
                std::string("CREATE TRIGGER t AFTER UPDATE OF height ON lamp_post BEGIN ") + body + "; END");
    const char* all = "SELECT group_concat(uid || height) || (SELECT count(*) FROM run) FROM lamp_post";
    const std::string before = query_text(copy, all);
    MapEditor editor = MapEditor::open(copy);
    Landmark landmark = editor.map().query({.limit = 1}).at(0);
    landmark.features[0].value += 1;
    EXPECT_THAT(problem_of([&] { editor.update(landmark); }),
                AllOf(HasSubstr("a trigger that is not Waymark's"), HasSubstr("copy.gpkg")))
        << body;
    EXPECT_EQ(query_text(copy, all), before) << body;
  }
}

// GDAL makes such triggers in every GeoPackage that it changes.
TEST_F(HostileFile, ATriggerThatCountsRowsIsNoFault) {
  execute_sql(map_,
              "CREATE TABLE gpkg_ogr_contents(table_name TEXT PRIMARY KEY, feature_count INTEGER);"
              "INSERT INTO gpkg_ogr_contents VALUES ('lamp_post', 60);"
              "CREATE TRIGGER c AFTER UPDATE ON lamp_post BEGIN UPDATE gpkg_ogr_contents SET feature_count = "
              "61; END");
  MapEditor editor = MapEditor::open(map_);
  Landmark landmark = editor.map().query({.limit = 1}).at(0);
  landmark.position.xyz.x() += 1;
  EXPECT_EQ(problem_of([&] { editor.update(landmark); }), "");
  EXPECT_EQ(query_text(map_, "SELECT feature_count FROM gpkg_ogr_contents"), "61");
}

TEST_F(HostileFile, AHugeValueIsRefused) {
  const sqlite::Database database(map_, sqlite::OpenMode::read);
  EXPECT_THAT(refusal([&] { database.integer("SELECT length(hex(zeroblob(200000000)))"); }),
              HasSubstr("more than 256 MB"));
}

TEST_F(HostileFile, ValuesOfAnotherKindAreNoFault) {
  execute_sql(map_,
              R"(UPDATE run SET inputs = '[{"path": 1, "bytes": "x", "sha256": []}, 5, {"bytes": -3}]')");
  const auto runs = MapStore::open(map_).runs();
  ASSERT_EQ(runs.at(0).inputs.size(), 2U);
  EXPECT_EQ(runs[0].inputs[0], (InputFile{"", 0, ""}));
  std::string codes;
  for (const Finding& finding : validate_map(map_)) codes += finding.code + " ";
  EXPECT_THAT(codes, HasSubstr("run.hash"));
}

TEST_F(HostileFile, AnObservationOfAnUnknownTypeIsNamed) {
  execute_sql(map_, "UPDATE observation SET type = 'nothing'");
  EXPECT_THAT(refusal([&] { MapStore::open(map_).observations(); }),
              HasSubstr("'nothing', which the map does not declare"));
}

TEST_F(HostileFile, StylesOfATypeAreCheckedByKind) {
  execute_sql(map_,
              "UPDATE waymark_type SET colour = 'red', size_feature = '\"/><x', label_feature = 'no_such'");
  const LandmarkType type = MapStore::open(map_).types()[0];
  EXPECT_EQ(type.colour, "#888888");
  EXPECT_THAT(type.size_feature, IsEmpty());
  EXPECT_THAT(type.label_feature, IsEmpty());
  std::string codes;
  for (const Finding& finding : validate_map(map_)) codes += finding.code + " ";
  EXPECT_THAT(codes, AllOf(HasSubstr("type.colour"), HasSubstr("type.style")));
}

TEST_F(HostileFile, ADamagedMapIsNotCopied) {
  execute_sql(map_, "DROP TRIGGER rtree_lamp_post_geom_insert");
  const auto copy = folder_ / "copy.gpkg";
  EXPECT_THAT(refusal([&] { update_map(map_, copy, [](MapEditor&) {}); }),
              StartsWith("the map has errors that its copy would have, too"));
  EXPECT_FALSE(std::filesystem::exists(copy));
}

}  // namespace
}  // namespace waymark::test
