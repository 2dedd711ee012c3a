// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "geodb/write_map.hpp"
#include "small_map.hpp"

namespace waymark::test {
namespace {

constexpr int kNoQgis = 77;

/// QGIS opens a map with a valid CRS and the map's own style; see qgis_render.py.
void expect_qgis_draws(const std::filesystem::path& map, const std::filesystem::path& picture) {
  const std::string script = WAYMARK_SOURCE_DIR "/tests/exporters/qgis_render.py";
  const std::string log = picture.string() + ".log";
  const std::string command = "/usr/bin/python3 '" + script + "' '" + map.string() + "' '" +
                              picture.string() + "' > '" + log + "' 2>&1";
  const int status = std::system(command.c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == kNoQgis || code == 127) GTEST_SKIP() << "QGIS is not installed (python3-qgis)";
  EXPECT_EQ(code, 0) << test::content_of(log);
  EXPECT_EQ(test::content_of(picture).substr(1, 3), "PNG");
}

TEST(QgisRender, DrawsAnEarthMapWithItsStyle) {
  const test::TemporaryFolder folder;
  test::write_two_type_map(folder / "map.gpkg");
  expect_qgis_draws(folder / "map.gpkg", folder / "map.png");
}

TEST(QgisRender, DrawsCratersToScale) {
  const test::TemporaryFolder folder;
  test::write_crater_map(folder / "mars.gpkg", "IAU_2015:49900", 77, 40, 1);
  expect_qgis_draws(folder / "mars.gpkg", folder / "mars.png");
  test::write_crater_map(folder / "local.gpkg", "local", 0, 0, 50'000);
  expect_qgis_draws(folder / "local.gpkg", folder / "local.png");
}

TEST(QgisRender, DrawsStandsInClassesAndLines) {
  const test::TemporaryFolder folder;
  geodb::MapContents map = test::three_summits("EPSG:32632", 450'000, 5'050'000, 1000);
  geodb::ShapeLayer stands{.name = "stand",
                           .summary = "Stands",
                           .columns = {{"volume", "m3/ha", AttributeSpec::Kind::real, ""}},
                           .style = {.fill = "#a5d6a7", .graduated = "volume"}};
  for (const double volume : {127.179463898547, 182.208887808091, 224.910330979472}) {
    const double x = 450'000 + 10 * volume, y = 5'050'000;
    stands.rows.push_back(
        {{{.outer = {{x, y}, {x + 300, y}, {x + 300, y + 900}, {x, y + 900}, {x, y}}}}, {volume}});
    stands.style.classes.push_back(volume);
  }
  map.layers = {stands,
                {.name = "track",
                 .summary = "",
                 .kind = geodb::ShapeKind::line,
                 .columns = {},
                 .rows = {{{{.outer = {{450'000, 5'050'000}, {452'000, 5'051'000}}}}, {}}}}};
  geodb::write_map(folder / "map.gpkg", map);
  expect_qgis_draws(folder / "map.gpkg", folder / "map.png");
}

TEST(QgisRender, DrawsWallsToScaleAlongTheirFaces) {
  const test::TemporaryFolder folder;
  geodb::MapContents map = test::three_summits("EPSG:32632", 450'000, 5'050'000, 100);
  const TypeId id = map.types.id("wall");
  const LandmarkType& type = map.types[id];
  map.landmarks.clear();
  for (int i = 0; i < 3; ++i) {
    Landmark wall;
    wall.uid = "wa-" + std::to_string(i);
    wall.type = id;
    wall.position.xyz = {450'000.0 + 40 * i, 5'050'000.0 + 30 * i, 0};
    wall.features.resize(type.features.size());
    wall.features[feature_index(type, "direction")] = {0.7 - 0.3 * i, 0.01, 1};
    wall.features[feature_index(type, "length")] = {25, 0.1, 1};
    wall.quality = {1, 2, std::vector<std::optional<double>>(type.features.size())};
    map.landmarks.push_back(wall);
  }
  geodb::write_map(folder / "map.gpkg", map);
  expect_qgis_draws(folder / "map.gpkg", folder / "map.png");
}

TEST(QgisRender, KnowsThePlanetaryCrs) {
  const test::TemporaryFolder folder;
  test::write_mars_map(folder / "map.gpkg");
  expect_qgis_draws(folder / "map.gpkg", folder / "map.png");
}

}  // namespace
}  // namespace waymark::test
