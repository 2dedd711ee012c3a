// SPDX-License-Identifier: Apache-2.0
// The page of a web map in a browser. Its libraries come from the folder that WAYMARK_MAPLIBRE names
// (scripts/fetch-maplibre): no test needs the network.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using Json = nlohmann::json;
namespace fs = std::filesystem;

/// 200 rocks on a plane of 100 m, one of them alone in the middle.
class WebCommand : public testing::Test {
 protected:
  void SetUp() override {
    std::string table = "uid,x,y,z,radius,height\nmiddle,50,50,0,2.5,1.25\n";
    for (int i = 0; i < 200; ++i)
      table += fmt::format("rock-{},{},{},0,{},0.3\n", i, i % 20 < 10 ? 3 * (i % 10) : 100 - 3 * (i % 10),
                           i / 2.0, 0.2 + 0.001 * i);
    write_text(folder_ / "rocks.csv", table);
    const Outcome made =
        waymark({"import", folder_ / "rocks.csv", "--type", "rock", "--map-crs", "local", "-o", map_});
    ASSERT_EQ(made.code, 0) << made.err;
    MadeDem dem{.columns = 120, .rows = 120};
    dem.crs = "";
    dem.geotransform = {-10, 1, 0, 110, 0, -1};
    dem.height = [](int column, int row) {
      return -2500 + 3 * std::sin(0.2 * column) * std::cos(0.15 * row);
    };
    make_dem(folder_ / "dem.tif", dem);
  }

  static std::string library() {
    const char* folder = std::getenv("WAYMARK_MAPLIBRE");
    return folder == nullptr ? "" : folder;
  }

  /// Returns the values of the steps of view_browser.py, then the list of the server; none without Chromium.
  std::vector<Json> browse(const std::vector<std::string>& steps, const std::string& server_option = "") {
    std::string line = fmt::format(
        "timeout 200 /usr/bin/python3 '{0}/tests/apps/serve_folder.py' {1} '{2}' /usr/bin/python3 "
        "'{0}/tests/apps/view_browser.py' '{{url}}/index.html'",
        WAYMARK_SOURCE_DIR, server_option, site_);
    for (const std::string& step : steps) line += " '" + step + "'";
    const Outcome outcome = bash(line);
    if (outcome.code == kNoBrowser || outcome.code == 127) return {};
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::vector<Json> values;
    std::istringstream lines(outcome.out);
    for (std::string text; std::getline(lines, text);) values.push_back(Json::parse(text));
    EXPECT_EQ(values.size(), steps.size() + 1);
    values.resize(steps.size() + 1);
    return values;
  }

  TempFolder folder_;
  std::string map_ = folder_ / "rocks.gpkg", site_ = folder_ / "site";
};

TEST_F(WebCommand, WritesAFolderAndSaysWhatIsMissing) {
  const Outcome outcome = waymark({"web", map_, "-o", site_, "--dem", folder_ / "dem.tif"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("201 landmarks in "));
  EXPECT_THAT(outcome.err, HasSubstr("Terrain, 1 m per pixel"));
  EXPECT_THAT(outcome.err, HasSubstr("sh fetch-maplibre lib"));
  for (const char* name : {"index.html", "site.js", "site.css", "style.json", "fetch-maplibre",
                           "landmarks.pmtiles", "terrain.pmtiles"})
    EXPECT_TRUE(fs::exists(fs::path(site_) / name)) << name;
  ASSERT_EQ(waymark({"web", map_, "-o", site_, "--terrain-pixels", "0"}).code, 0);
  EXPECT_FALSE(fs::exists(fs::path(site_) / "terrain.pmtiles"));
}

TEST_F(WebCommand, WithoutItsLibraryThePageSaysHowToGetIt) {
  ASSERT_EQ(waymark({"web", map_, "-o", site_}).code, 0);
  const auto values = browse({"eval:document.querySelector(\".problem\").textContent"});
  if (values.empty()) GTEST_SKIP() << "Chromium is not installed (chromium)";
  EXPECT_THAT(values[0].get<std::string>(), HasSubstr("sh fetch-maplibre lib"));
}

TEST_F(WebCommand, TheBrowserShowsTheLandmarks) {
  if (library().empty()) GTEST_SKIP() << "WAYMARK_MAPLIBRE names no folder of scripts/fetch-maplibre";
  ASSERT_EQ(waymark({"web", map_, "-o", site_, "--dem", folder_ / "dem.tif", "--assets", library()}).code, 0);
  const std::vector<std::string> steps{
      "eval:waymark.about.crs",
      "eval:new Set(waymark.map.queryRenderedFeatures({layers: [\"rock\"]}).map(f => f.properties.uid)).size",
      "clickon:waymark.map.project([50 / 6371008.8 * 180 / Math.PI, 50 / 6371008.8 * 180 / Math.PI])",
      "eval:document.querySelector(\".maplibregl-popup\").innerText",
      // The bar against positions that are known: 100 m of x in pixels, and the bar in metres.
      "eval:(() => { const d = 180 / Math.PI / 6371008.8, p = x => waymark.map.project([x * d, 50 * d]).x;"
      " const bar = document.querySelector(\"#scale span\").getBoundingClientRect().width;"
      " return [parseFloat(document.getElementById(\"scale\").innerText), bar / (p(100) - p(0)) * 100]; })()",
      // A height of the terrain tiles is read back through the style's decoding: the camera sees it.
      "eval:document.getElementById(\"relief\").click()",
      "eval:(() => { const at = [50.5, 50.5].map(x => x / 6371008.8 * 180 / Math.PI);"
      " return waymark.map.queryTerrainElevation(at) + waymark.about.lowest; })()",
      "eval:(() => { const s = document.getElementById(\"confidence\"); s.value = 1; s.oninput(); "
      "document.querySelector(\"#panel input\").click(); return 1; })()",
      "eval:waymark.map.queryRenderedFeatures({layers: [\"rock\"]}).length", "errors", "requests",
      // The relief is seen in the middle, and nothing beyond its edge at x = -10.
      "eval:[50, -9, -11].map(x => waymark.map.queryRenderedFeatures(waymark.map.project([x / 6371008.8 * "
      "180 / "
      "Math.PI, 50 / 6371008.8 * 180 / Math.PI]), {layers: [\"beyond_terrain\"]}).length)"};
  const auto values = browse(steps);
  if (values.empty()) GTEST_SKIP() << "Chromium is not installed (chromium)";
  EXPECT_EQ(values[0], "local");
  EXPECT_EQ(values[1], 201);
  EXPECT_THAT(values[3].get<std::string>(), HasSubstr("middle"));
  EXPECT_THAT(values[3].get<std::string>(), HasSubstr("2.50\u00a0m"));
  EXPECT_THAT(values[3].get<std::string>(), HasSubstr("not assessed"));
  EXPECT_GE(values[4][0].get<double>(), 5);
  EXPECT_NEAR(values[4][1].get<double>() / values[4][0].get<double>(), 1, 0.01);
  // Cell (60, 59) of the DEM, the middle of the map.
  EXPECT_NEAR(values[6].get<double>(), -2500 + 3 * std::sin(0.2 * 60) * std::cos(0.15 * 59), 0.25);
  EXPECT_EQ(values[8], 0);
  EXPECT_THAT(values[9], IsEmpty());
  for (const Json& url : values[10])
    EXPECT_TRUE(url.get<std::string>().starts_with("http://127.0.0.1") ||
                url.get<std::string>().starts_with("blob:"))
        << url;
  EXPECT_EQ(values[11], Json({0, 0, 1}));
  for (const Json& range : values.back()) EXPECT_NE(range[1], "whole");
}

TEST_F(WebCommand, APopupLiesOverThePanelAndHiddenLandmarksAreCounted) {
  if (library().empty()) GTEST_SKIP() << "WAYMARK_MAPLIBRE names no folder of scripts/fetch-maplibre";
  std::string table = "uid,x,y,radius,radius_sd\n";
  for (int i = 0; i < 1500; ++i) table += fmt::format("rock-{},{},{},1.5,0.25\n", i, i % 50, i / 50);
  write_text(folder_ / "many.csv", table);
  const std::string many = folder_ / "many.gpkg";
  ASSERT_EQ(
      waymark({"import", folder_ / "many.csv", "--type", "rock", "--map-crs", "local", "-o", many}).code, 0);
  ASSERT_EQ(waymark({"web", many, "-o", site_, "--assets", library()}).code, 0);
  const auto values = browse(
      {"eval:waymark.map.jumpTo({zoom: 18}), 1", "eval:document.getElementById(\"hidden\").innerText",
       // A landmark beside the panel, so that its popup reaches over it.
       "eval:(waymark.map.jumpTo({zoom: 22, center: [2e-4, 1e-4]}), 1)",
       "clickon:waymark.map.queryRenderedFeatures({layers: [\"rock\"]}).map(f => "
       "waymark.map.project(f.geometry.coordinates)).find(p => p.x > 295 && p.x < 355 && p.y > 240 && p.y < "
       "310)",
       "eval:(() => { const box = document.querySelector(\".maplibregl-popup\").getBoundingClientRect(), "
       "panel = document.getElementById(\"panel\").getBoundingClientRect(), "
       "x = (Math.max(box.left, panel.left) + panel.right) / 2, "
       "y = (Math.max(box.top, panel.top) + Math.min(box.bottom, panel.bottom)) / 2; "
       "return [box.left < panel.right && box.top < panel.bottom, "
       "!!document.elementFromPoint(x, y).closest(\".maplibregl-popup\")]; })()",
       "eval:document.querySelector(\".maplibregl-popup\").innerText",
       "eval:document.getElementById(\"hidden\").innerText"});
  if (values.empty()) GTEST_SKIP() << "Chromium is not installed (chromium)";
  EXPECT_THAT(values[1].get<std::string>(), HasSubstr("lesser landmarks"));
  EXPECT_EQ(values[4], Json({true, true}));
  EXPECT_THAT(values[5].get<std::string>(), HasSubstr("1.50 \u00b1 0.25\u00a0m"));
  EXPECT_EQ(values[6], "");
}

TEST_F(WebCommand, StandsAreAreasWithALegendAndPopups) {
  if (library().empty()) GTEST_SKIP() << "WAYMARK_MAPLIBRE names no folder of scripts/fetch-maplibre";
  std::string table = "uid,x,y,height,diameter\n";
  for (int i = 0; i < 36; ++i)
    table +=
        fmt::format("tree-{},{},{},{},0.3\n", i, 500005 + 10 * (i % 6), 5200005 + 10 * (i / 6), 15 + i % 7);
  write_text(folder_ / "trees.csv", table);
  write_text(folder_ / "stands.geojson", R"({"type": "FeatureCollection",
    "crs": {"type": "name", "properties": {"name": "EPSG:32632"}}, "features": [
    {"type": "Feature", "properties": {"stand": "east"}, "geometry": {"type": "Polygon", "coordinates":
    [[[500030, 5200000], [500060, 5200000], [500060, 5200060], [500030, 5200060], [500030, 5200000]]]}},
    {"type": "Feature", "properties": {"stand": "west"}, "geometry": {"type": "Polygon", "coordinates":
    [[[500000, 5200000], [500030, 5200000], [500030, 5200060], [500000, 5200060], [500000, 5200000]]]}}]})");
  const std::string trees = folder_ / "trees.gpkg";
  ASSERT_EQ(
      waymark({"import", folder_ / "trees.csv", "--type", "tree", "--map-crs", "EPSG:32632", "-o", trees})
          .code,
      0);
  const Outcome counted = waymark({"inventory", trees, "--stands", folder_ / "stands.geojson", "-o", trees});
  ASSERT_EQ(counted.code, 0) << counted.err;
  const Outcome made = waymark({"web", trees, "-o", site_, "--assets", library()});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("2 areas of layer stand"));
  const auto values = browse(
      {"eval:[...new Set(waymark.map.queryRenderedFeatures({layers: [\"stand_area\"]}).map(f => "
       "f.properties.stand))].sort()",
       "eval:document.getElementById(\"shapes_stand\").parentElement.innerText",
       // Between four trees of the western stand.
       "clickon:(() => { const f = waymark.map.queryRenderedFeatures({layers: [\"tree\"]}), at = uid => "
       "f.find(one => one.properties.uid === uid).geometry.coordinates, a = at(\"tree-13\"), b = "
       "at(\"tree-20\"); "
       "return waymark.map.project([(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]); })()",
       "eval:document.querySelector(\".maplibregl-popup\").innerText",
       "eval:(document.getElementById(\"shapes_stand\").click(), 1)",
       "eval:waymark.map.queryRenderedFeatures({layers: [\"stand_area\", \"stand_outline\"]}).length",
       "errors"});
  if (values.empty()) GTEST_SKIP() << "Chromium is not installed (chromium)";
  EXPECT_EQ(values[0], Json({"east", "west"}));
  EXPECT_THAT(values[1].get<std::string>(), HasSubstr("Stand"));
  EXPECT_THAT(values[3].get<std::string>(), HasSubstr("west"));
  EXPECT_THAT(values[3].get<std::string>(), HasSubstr("Stems\t"));
  EXPECT_THAT(values[3].get<std::string>(), HasSubstr(" \u00b1 "));
  EXPECT_THAT(values[3].get<std::string>(), testing::Not(HasSubstr("D005")));
  EXPECT_EQ(values[5], 0);
  EXPECT_THAT(values[6], IsEmpty());
}

TEST_F(WebCommand, AServerWithoutRangesServesTheMapToo) {
  if (library().empty()) GTEST_SKIP() << "WAYMARK_MAPLIBRE names no folder of scripts/fetch-maplibre";
  ASSERT_EQ(waymark({"web", map_, "-o", site_, "--assets", library()}).code, 0);
  const auto values =
      browse({"eval:waymark.map.queryRenderedFeatures({layers: [\"rock\"]}).length > 0"}, "--no-ranges");
  if (values.empty()) GTEST_SKIP() << "Chromium is not installed (chromium)";
  EXPECT_EQ(values[0], true);
}

}  // namespace
}  // namespace waymark::test
