// SPDX-License-Identifier: Apache-2.0
#include "geodb/validate_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geodb/map_editor.hpp"
#include "geodb/write_map.hpp"
#include "tests/geodb/map_scenes.hpp"

namespace waymark::test {
using namespace geodb;
namespace {

TEST(ValidateMap, ASoundMapHasNoFindings) {
  const TemporaryFolder folder;
  for (const char* crs : {"EPSG:32632", "IAU_2015:30100", ""}) {
    MapContents contents = scattered({.crs = crs});
    contents.dem_coverage = ramp_dem(contents.crs, 300, 300);
    write_map(folder / "map.gpkg", contents);
    EXPECT_THAT(validate_map(folder / "map.gpkg"), ::testing::IsEmpty());
  }
}

struct Fault {
  const char* code;
  const char* sql;
};
void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.code;
}

const Fault kFaults[] = {
    {"file.foreign_key", "UPDATE gpkg_contents SET srs_id = 77 WHERE table_name = 'lamp_post'"},
    {"view.missing", "DROP VIEW landmark"},
    {"view.recursive",
     "DROP VIEW landmark; CREATE VIEW landmark AS WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 "
     "FROM c) SELECT n AS id FROM c"},
    {"view.recursive",
     "CREATE VIEW mine AS SELECT n FROM (WITH\r\nRECURSIVE c(n) AS (SELECT 1 UNION SELECT n + 1 FROM c) "
     "SELECT n FROM c)"},
    {"layer.unregistered", "DELETE FROM gpkg_contents WHERE table_name = 'lamp_post'"},
    {"layer.unregistered", "DELETE FROM gpkg_geometry_columns WHERE table_name = 'lamp_post'"},
    {"style.missing", "DELETE FROM layer_styles"},
    {"run.missing", "DELETE FROM run"},
    {"run.json", "UPDATE run SET report = '{'"},
    {"run.hash", "UPDATE run SET inputs = '[{\"path\":\"a\",\"sha256\":\"12\"}]'"},
    {"crs.unknown",
     "UPDATE gpkg_spatial_ref_sys SET organization = 'NONE', definition = '?', definition_12_063 = '?' WHERE "
     "srs_id = 32632"},
    {"column.missing", "ALTER TABLE lamp_post DROP COLUMN height_q"},
    {"table.missing", "DROP VIEW landmark; DROP TABLE lamp_post"},
    {"geometry.bad", "UPDATE lamp_post SET geom = x'4750' WHERE id = 7"},
    {"geometry.bad", "UPDATE lamp_post SET geom = NULL WHERE id = 7"},
    {"geometry.crs",
     "UPDATE lamp_post SET geom = x'47500001' || x'00000000' || substr(geom, 9) WHERE id = 7"},
    {"uid.empty", "UPDATE lamp_post SET uid = '' WHERE id = 7"},
    {"uid.twice", "DROP INDEX lamp_post_uid; UPDATE lamp_post SET uid = 'lp-1' WHERE id = 7"},
    {"position.moved", "UPDATE lamp_post SET geom = (SELECT geom FROM lamp_post WHERE id = 8) WHERE id = 7"},
    {"feature.range", "UPDATE lamp_post SET height = 300 WHERE id = 7"},
    {"feature.spread", "UPDATE lamp_post SET height_sd = -1 WHERE id = 7"},
    {"feature.spread", "UPDATE lamp_post SET height = NULL WHERE id = 7"},
    {"quality.range", "UPDATE lamp_post SET height_q = 1.5 WHERE id = 7"},
    {"quality.range", "UPDATE lamp_post SET confidence = -0.1 WHERE id = 7"},
    {"quality.counts", "UPDATE lamp_post SET seen = 9 WHERE id = 7"},
    {"quality.stale", "UPDATE lamp_post SET quality = 0.5 WHERE id = 7"},
    {"quality.stale", "UPDATE lamp_post SET q_multiplicity = NULL WHERE id = 7"},
    {"covariance.bad", "UPDATE lamp_post SET cov_xy = 9 WHERE id = 7"},
    {"covariance.bad", "UPDATE lamp_post SET var_z = -1 WHERE id = 7"},
    {"bound.above", "UPDATE lamp_post SET height_low = 19.5 WHERE id = 7"},
    {"rtree.missing", "DROP TABLE rtree_lamp_post_geom"},
    {"rtree.trigger", "DROP TRIGGER rtree_lamp_post_geom_update3"},
    {"edits.trigger", "DROP TRIGGER lamp_post_moved"},
    {"edits.trigger", "DROP TRIGGER lamp_post_added; DROP TRIGGER lamp_post_removed"},
    {"rtree.damaged", "UPDATE rtree_lamp_post_geom_rowid SET nodeno = nodeno % 3 + 2 WHERE rowid = 7"},
    {"rtree.row", "DELETE FROM rtree_lamp_post_geom WHERE id = 7"},
    {"rtree.orphan", "INSERT INTO rtree_lamp_post_geom VALUES (5000, 1, 1, 1, 1)"},
    {"rtree.box", "UPDATE rtree_lamp_post_geom SET minx = minx + 1000, maxx = maxx + 1000 WHERE id = 7"},
    {"rtree.box", "UPDATE rtree_lamp_post_geom SET miny = 0 WHERE id = 7"},
    {"layer.extent", "UPDATE gpkg_contents SET max_x = 450000 WHERE table_name = 'lamp_post'"},
    {"evidence.table", "DROP TABLE lamp_post_observation"},
    {"evidence.dead_link", "UPDATE lamp_post_observation SET base_id = 9999 WHERE related_id = 3"},
    {"evidence.dead_link", "DELETE FROM observation WHERE id = 3"},
    {"evidence.no_link", "DELETE FROM lamp_post_observation WHERE related_id = 3"},
    {"evidence.no_link", "UPDATE observation SET uid = 'lp-900' WHERE id = 3"},
    {"evidence.count", "UPDATE lamp_post SET observations = 0 WHERE uid = 'lp-2'"},
    {"evidence.type", "UPDATE observation SET type = 'ghost' WHERE id = 21"},
    {"evidence.weight", "UPDATE observation SET weight = 0 WHERE id = 3"},
    {"evidence.image", "UPDATE image SET name = 'other'"},
    {"evidence.features", "UPDATE observation SET features = '{' WHERE id = 3"},
};

class PlantedFault : public ::testing::TestWithParam<Fault> {};

TEST_P(PlantedFault, IsFound) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  execute_sql(folder / "map.gpkg", GetParam().sql);
  const auto findings = validate_map(folder / "map.gpkg");
  EXPECT_THAT(findings, ::testing::Contains(::testing::Field(&Finding::code, GetParam().code)))
      << GetParam().sql;
}

INSTANTIATE_TEST_SUITE_P(Each, PlantedFault, ::testing::ValuesIn(kFaults));

TEST(ValidateMap, AnEditByWaymarkIsNoStaleMove) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  MapEditor editor = MapEditor::open(folder / "map.gpkg");
  Landmark post = *editor.map().find("lp-500");
  post.position.xyz.x() += 5;
  editor.update(post);
  EXPECT_THAT(validate_map(folder / "map.gpkg"), ::testing::IsEmpty());
}

TEST(ValidateMap, ALandmarkThatAPersonAddsIsNamedAndSound) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  execute_sql(folder / "map.gpkg",
              "INSERT INTO lamp_post (geom, height) SELECT geom, 9 FROM lamp_post WHERE id = 7;"
              "INSERT INTO lamp_post (geom, height, uid) SELECT geom, 9, '' FROM lamp_post WHERE id = 8");
  EXPECT_THAT(validate_map(folder / "map.gpkg"), ::testing::IsEmpty());
  EXPECT_EQ(
      query_text(folder / "map.gpkg",
                 "SELECT count(DISTINCT uid) FROM lamp_post WHERE id > 1000 AND uid LIKE 'lamp_post-%'"),
      "2");
}

TEST(WriteMap, ALayerOfImagesNeedsImages) {
  const TemporaryFolder folder;
  const auto layers = [&](const Scene& scene) {
    write_map(folder / "map.gpkg", scattered(scene));
    return query_text(folder / "map.gpkg", "SELECT count(*) FROM gpkg_contents WHERE table_name = 'image'");
  };
  EXPECT_EQ(layers({.with_evidence = 3}), "1");
  EXPECT_EQ(layers({.with_evidence = 0}), "0");
  EXPECT_THAT(validate_map(folder / "map.gpkg"), ::testing::IsEmpty());
  ImageRecord image;
  image.name = "first";
  image.footprint = {{{0, 0}, {1, 0}, {1, 1}}};
  MapEditor::open(folder / "map.gpkg").add_image(image);
  EXPECT_EQ(query_text(folder / "map.gpkg", "SELECT count(*) FROM rtree_image_geom"), "1");
  EXPECT_EQ(MapStore::open(folder / "map.gpkg").images().size(), 1u);
}

TEST(ValidateMap, CountsWhatItDoesNotList) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  execute_sql(folder / "map.gpkg", "UPDATE lamp_post SET height = 30");
  const auto findings = validate_map(folder / "map.gpkg");
  EXPECT_EQ(findings.size(), 101u);
  EXPECT_EQ(findings.back().text, "and 900 more of these");
}

}  // namespace
}  // namespace waymark::test
