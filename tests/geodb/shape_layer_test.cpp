// SPDX-License-Identifier: Apache-2.0
#include "geodb/shape_layer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "geodb/geopackage/shape_blob.hpp"
#include "geodb/layers/shape_table.hpp"
#include "geodb/map_store.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "tests/geodb/map_scenes.hpp"
#include "tests/support/message_of.hpp"

namespace waymark::test {
using namespace geodb;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Kind = AttributeSpec::Kind;

ShapeLayer squares(int count) {
  ShapeLayer layer{.name = "crown",
                   .summary = "Crowns",
                   .columns = {{"uid", "", Kind::text, "of the tree"},
                               {"area", "m2", Kind::real, ""},
                               {"cells", "", Kind::integer, ""}},
                   .style = {.colour = "#2e7d32", .fill = "#66bb6a", .label = "uid"}};
  for (int i = 0; i < count; ++i) {
    const double x = 450'000 + 37.0 * (i % 101), y = 5'050'000 + 91.0 * (i / 101);
    ShapePart part{.outer = {{x, y}, {x + 10, y}, {x + 10, y + 10}, {x, y + 10}, {x, y}}};
    if (i % 2 == 0) part.holes = {{{x + 2, y + 2}, {x + 2, y + 4}, {x + 4, y + 4}, {x + 2, y + 2}}};
    layer.rows.push_back({{part}, {"t" + std::to_string(i), 100.0 + i, std::int64_t{i}}});
  }
  return layer;
}

ShapeLayer track() {
  return {
      .name = "track",
      .summary = "Where it drove",
      .kind = ShapeKind::line,
      .columns = {{"t", "s", Kind::real, ""}},
      .rows = {{{{.outer = {{450'000, 5'050'000}, {450'001, 5'050'002}}}}, {1.5}}, {{}, {AttributeValue{}}}}};
}

ShapeLayer harvested() {
  return {.name = "harvested",
          .summary = "",
          .kind = ShapeKind::point,
          .columns = {},
          .rows = {{{{.outer = {{450'003, 5'050'004}}}}, {}}}};
}

void expect_equal(const ShapeLayer& a, const ShapeLayer& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.summary, b.summary);
  EXPECT_EQ(a.kind, b.kind);
  ASSERT_EQ(a.columns.size(), b.columns.size());
  for (std::size_t i = 0; i < a.columns.size(); ++i) {
    EXPECT_EQ(a.columns[i].name, b.columns[i].name);
    EXPECT_EQ(a.columns[i].unit, b.columns[i].unit);
    EXPECT_EQ(a.columns[i].kind, b.columns[i].kind);
  }
  ASSERT_EQ(a.rows.size(), b.rows.size());
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    EXPECT_EQ(a.rows[i].parts, b.rows[i].parts) << i;
    EXPECT_EQ(a.rows[i].values, b.rows[i].values) << i;
  }
}

TEST(ShapeLayer, ReadsBackAsWrittenWithTheMap) {
  const TemporaryFolder folder;
  for (const char* crs : {"EPSG:32632", ""}) {
    MapContents contents = scattered({.crs = crs});
    contents.layers = {squares(300), track(), harvested()};
    write_map(folder / "map.gpkg", contents);
    EXPECT_THAT(validate_map(folder / "map.gpkg"), IsEmpty());
    EXPECT_THAT(shape_layers(folder / "map.gpkg"), ElementsAre("crown", "harvested", "track"));
    for (const ShapeLayer& layer : contents.layers)
      expect_equal(read_shape_layer(folder / "map.gpkg", layer.name), layer);
    EXPECT_EQ(MapStore::open(folder / "map.gpkg").count(), 1000);
  }
}

TEST(ShapeLayer, IsAddedToAMapAndReplaced) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  EXPECT_THAT(shape_layers(folder / "map.gpkg"), IsEmpty());
  for (const int count : {20, 7, 0}) {
    const std::vector layers{squares(count), track()};
    write_layers(folder / "map.gpkg", layers);
    EXPECT_THAT(validate_map(folder / "map.gpkg"), IsEmpty());
    expect_equal(read_shape_layer(folder / "map.gpkg", "crown"), squares(count));
  }
}

TEST(ShapeLayer, IsDrawnOpaqueInQgisAndEveryValueHasAClass) {
  ShapeLayer layer = squares(3);
  const double least = 127.179463898547, most = 224.910330979472;
  layer.style.graduated = "area";
  layer.style.classes = {least, 182.208887808091, most};
  const std::string qml = qml_shape_style(layer);
  EXPECT_THAT(qml, HasSubstr(R"(name="outline_color" value="46,125,50,255")"));
  const auto bound = [&](const std::string& name, std::size_t from) {
    return std::stod(qml.substr(qml.find(name + "=\"", from) + name.size() + 2));
  };
  EXPECT_LE(bound("lower", 0), least);
  EXPECT_GE(bound("upper", qml.rfind("<range ")), most);
  EXPECT_THAT(qml_shape_style(track()), HasSubstr(R"(name="line_color" value="136,136,136,255")"));
  EXPECT_THAT(qml_shape_style(harvested()), HasSubstr(R"(name="color" value="136,136,136,255")"));
}

TEST(ShapeLayer, HeadingsOfColumnsNameTheirUnitOnce) {
  ShapeLayer layer = track();
  layer.columns = {{"height_m", "m", Kind::real, ""},
                   {"basal_area_m2_per_ha_se", "m2/ha", Kind::real, ""},
                   {"stems_per_ha", "1/ha", Kind::real, ""},
                   {"elevation", "m", Kind::real, ""}};
  const std::string qml = qml_shape_style(layer);
  for (const char* title :
       {"Height (m)", "Basal area, standard error (m2/ha)", "Stems (1/ha)", "Elevation (m)"})
    EXPECT_THAT(qml, HasSubstr("name=\"" + std::string(title) + "\""));
}

TEST(ShapeLayer, IsFoundByGdalWithItsHoles) {
  const TemporaryFolder folder;
  MapContents contents = scattered({});
  contents.layers = {squares(2)};
  write_map(folder / "map.gpkg", contents);
  const std::string info =
      run_program("ogrinfo -al -ro " + (folder / "map.gpkg").string() + " crown 2>&1").output;
  EXPECT_THAT(info, HasSubstr("Geometry: Multi Polygon"));
  EXPECT_THAT(info, HasSubstr("Feature Count: 2"));
  EXPECT_THAT(info, HasSubstr("(450002 5050002,"));  // the hole
}

TEST(ShapeLayer, FaultsAreFoundByValidate) {
  const std::pair<const char*, const char*> faults[] = {
      {"geometry.bad", "UPDATE crown SET geom = x'4750' WHERE id = 3"},
      {"geometry.crs", "UPDATE crown SET geom = x'47500003' || x'00000000' || substr(geom, 9) WHERE id = 3"},
      {"rtree.row", "DELETE FROM rtree_crown_geom WHERE id = 3"},
      {"style.missing", "DELETE FROM layer_styles WHERE f_table_name = 'crown'"},
      {"layer.extent", "UPDATE gpkg_contents SET max_x = 0 WHERE table_name = 'crown'"},
  };
  for (const auto& [code, sql] : faults) {
    const TemporaryFolder folder;
    MapContents contents = scattered({.landmarks = 3, .with_evidence = 0});
    contents.layers = {squares(5)};
    write_map(folder / "map.gpkg", contents);
    execute_sql(folder / "map.gpkg", sql);
    std::vector<std::string> codes;
    for (const Finding& finding : validate_map(folder / "map.gpkg")) codes.push_back(finding.code);
    EXPECT_THAT(codes, ::testing::Contains(code)) << sql;
  }
}

TEST(ShapeLayer, RejectsInvalidLayers) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  const std::string before = file_bytes(folder / "map.gpkg");
  const auto refused = [&](const ShapeLayer& layer) -> std::string {
    return message_of([&] { write_layers(folder / "map.gpkg", std::span(&layer, 1)); });
  };
  ShapeLayer layer = squares(2);
  layer.name = "lamp_post";
  EXPECT_THAT(refused(layer), HasSubstr("that name is taken"));
  layer.name = "Crown 1";
  EXPECT_THAT(refused(layer), HasSubstr("not a valid layer name"));
  layer = squares(2);
  layer.columns[0].name = "geom";
  EXPECT_THAT(refused(layer), HasSubstr("cannot have a column 'geom'"));
  layer = squares(2);
  layer.rows[1].values.pop_back();
  EXPECT_THAT(refused(layer), HasSubstr("2 values for 3 columns"));
  layer = squares(2);
  layer.rows[1].parts[0].outer[2].x() = std::nan("");
  EXPECT_THAT(refused(layer), HasSubstr("layer crown, row 2"));
  layer.rows[1].parts[0].outer.resize(2);
  EXPECT_THAT(refused(layer), HasSubstr("has 2 corners"));
  EXPECT_EQ(file_bytes(folder / "map.gpkg"), before) << "nothing half-written";
}

TEST(ShapeLayer, GeneratedRowsEqualRowsInMemory) {
  const ShapeLayer held = squares(500);
  ShapeLayer made = held;
  made.rows.resize(20);
  made.generator = [&](const auto& take) { std::for_each(held.rows.begin() + 20, held.rows.end(), take); };
  const TemporaryFolder folder;
  MapContents contents = scattered({});
  contents.layers = {made};
  write_map(folder / "map.gpkg", contents);
  expect_equal(read_shape_layer(folder / "map.gpkg", "crown"), held);
  EXPECT_THAT(validate_map(folder / "map.gpkg"), IsEmpty());
}

// Compares with a test of every box.
TEST(ShapeLayer, RowsOfAWindowAreThoseWhoseBoxesMeetIt) {
  TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({.landmarks = 10}));
  const ShapeLayer all = squares(2000);
  write_layers(folder / "map.gpkg", std::span(&all, 1), MapAccess::exclusive);
  EXPECT_EQ(count_shapes(folder / "map.gpkg", "crown"), 2000);
  EXPECT_EQ(count_shapes(folder / "map.gpkg", "track"), 0);
  for (const double side : {0.0, 5.0, 100.0, 1000.0, 1e7})
    for (const double x : {449'990.0, 450'000.0, 451'234.0, 453'700.0}) {
      const MapQuery::Box window{x, 5'050'000 - side, x + side, 5'050'300 + side};
      std::vector<std::int64_t> expected, found;
      for (const Shape& row : all.rows) {
        const Eigen::Vector2d& low = row.parts[0].outer[0];
        if (low.x() <= window.max_x && low.x() + 10 >= window.min_x && low.y() <= window.max_y &&
            low.y() + 10 >= window.min_y)
          expected.push_back(std::get<std::int64_t>(row.values[2]));
      }
      visit_shape_layer(
          folder / "map.gpkg", "crown", [](const ShapeLayer&) {},
          [&](Shape&& row) { found.push_back(std::get<std::int64_t>(row.values[2])); }, window);
      EXPECT_EQ(found, expected) << side << " at " << x;
    }
}

}  // namespace
}  // namespace waymark::test
