// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/made_drive.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Json = nlohmann::json;

/// Rocks of a plain, a log of a drive among them and an estimated track.
class ViewCommand : public testing::Test {
 protected:
  void SetUp() override {
    write_text(folder_ / "rocks.csv", rocks_csv());
    ASSERT_EQ(
        waymark({"import", folder_ / "rocks.csv", "--type", "rock", "--map-crs", "local", "-o", map_}).code,
        0);
    write_text(folder_ / "log.jsonl", drive_log({}));
    ASSERT_EQ(waymark({"localize", map_, folder_ / "log.jsonl", "-o", folder_ / "ekf.csv"}).code, 0);
    MadeDem dem{.columns = 60, .rows = 60};
    dem.crs = "";
    dem.geotransform = {-30, 1, 0, 30, 0, -1};
    dem.height = [](int column, int row) { return 3 * std::sin(0.2 * column) * std::cos(0.15 * row); };
    make_dem(folder_ / "dem.tif", dem);
  }

  Outcome view(std::vector<std::string> more = {}) {
    std::vector<std::string> words{"view", map_, "-o", page_, "--dem", folder_ / "dem.tif"};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  }

  /// Returns the values of the steps of view_browser.py; none if there is no Chromium.
  std::vector<Json> browse(const std::vector<std::string>& steps, const std::string& state = "") {
    std::string line = fmt::format("timeout 240 /usr/bin/python3 '{}/tests/apps/view_browser.py' '{}{}'",
                                   WAYMARK_SOURCE_DIR, page_, state);
    for (const std::string& step : steps) line += " '" + step + "'";
    const Outcome outcome = bash(line);
    if (outcome.code == kNoBrowser || outcome.code == 127) return {};
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::vector<Json> values;
    std::istringstream lines(outcome.out);
    for (std::string text; std::getline(lines, text);) values.push_back(Json::parse(text));
    EXPECT_EQ(values.size(), steps.size());
    values.resize(steps.size());
    return values;
  }

  TempFolder folder_;
  std::string map_ = folder_ / "map.gpkg", page_ = folder_ / "view.html";
};

/// Returns how many colours a picture has, and how many of its pixels differ from another one.
struct Compared {
  std::size_t colours = 0;
  double different = 0;
};
Compared compare(const std::string& file, const std::string& other) {
  GDALAllRegister();
  const auto read = [](const std::string& name) {
    const GDALDatasetUniquePtr picture(GDALDataset::Open(name.c_str(), GDAL_OF_RASTER));
    if (!picture) return std::vector<std::uint32_t>{};
    const int width = picture->GetRasterXSize(), height = picture->GetRasterYSize();
    std::vector<std::uint32_t> pixels(std::size_t(width) * std::size_t(height));
    if (picture->RasterIO(GF_Read, 0, 0, width, height, pixels.data(), width, height, GDT_Byte, 3, nullptr, 4,
                          4 * width, 1, nullptr) != CE_None)
      return std::vector<std::uint32_t>{};
    return pixels;
  };
  const auto a = read(file), b = read(other);
  Compared result{.colours = std::set<std::uint32_t>(a.begin(), a.end()).size()};
  if (a.size() != b.size() || a.empty()) return {result.colours, 1};
  for (std::size_t i = 0; i < a.size(); ++i) result.different += a[i] != b[i];
  result.different /= double(a.size());
  return result;
}

TEST_F(ViewCommand, WritesOnePageAndSaysHowLargeItIs) {
  const Outcome outcome =
      view({"--log", folder_ / "log.jsonl", "--track", "filter=" + (folder_ / "ekf.csv")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("view.html  "));
  const std::string page = text_of(page_);
  EXPECT_THAT(page, HasSubstr(R"("name":"filter","truth":false)"));
  EXPECT_THAT(page, HasSubstr(R"("name":"truth","truth":true)"));
}

TEST_F(ViewCommand, LandmarksBelowTheHorizonOfTheMiddleAreNamed) {
  const std::string table = folder_ / "moon.csv", map = folder_ / "moon.gpkg";
  write_text(table, "lon,lat,diam_km\n-60,0,5\n60,0,5\n");
  ASSERT_EQ(waymark({"import", table, "--type", "crater", "--map-crs", "IAU_2015:30100", "-o", map}).code, 0);
  const Outcome said = waymark({"view", map, "-o", page_});
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, HasSubstr("all landmarks lie more than 434 km from the middle of the map"));
}

TEST_F(ViewCommand, TheBrowserDrawsTheMapAndAClickChoosesALandmark) {
  ASSERT_EQ(view({"--log", folder_ / "log.jsonl", "--track", folder_ / "ekf.csv"}).code, 0);
  const std::string a = folder_ / "a.png", b = folder_ / "b.png", c = folder_ / "c.png";
  const auto values =
      browse({"shot:" + a, "eval:(waymark.eye.azimuth += 1, redraw(), 1)", "shot:" + b,
              "eval:scene.layers[0].uids[0]", "clickon:waymark.pixelOf(scene.layers[0].uids[0])",
              "eval:waymark.selected()", "eval:document.querySelector(\".details\").innerText", "shot:" + c,
              "errors", "requests", "eval:waymark.counts().rock"});
  if (values.empty()) GTEST_SKIP() << "Chromium is not installed (chromium)";
  const Compared turned = compare(a, b);
  EXPECT_GT(turned.colours, 2000u);  // shaded terrain; a blank page has a few dozen, of texts and panels
  EXPECT_GT(turned.different, 0.2);
  EXPECT_EQ(values[5], values[3]);
  EXPECT_THAT(values[6].get<std::string>(), HasSubstr("Radius"));
  EXPECT_THAT(values[6].get<std::string>(), HasSubstr("Confidence"));
  EXPECT_GT(compare(c, b).different, 0.01);  // the details and the chosen rock
  EXPECT_THAT(values[8], IsEmpty());
  EXPECT_EQ(values[9].size(), 1u) << values[9];  // the page itself
  EXPECT_EQ(values[10], made_rocks().size());
}

TEST_F(ViewCommand, PlaybackMovesTheRobotAndFollowsIt) {
  ASSERT_EQ(view({"--log", folder_ / "log.jsonl", "--track", folder_ / "ekf.csv"}).code, 0);
  const auto values =
      browse({"eval:waymark.now()", "eval:Math.round(eye.distance)", "eval:leadTrack().name",
              "eval:Math.hypot(eye.x - poseAt(leadTrack(), now).x, eye.y - poseAt(leadTrack(), now).y)",
              "eval:document.querySelector(\"footer .status\").textContent", "eval:ellipseLines.count",
              "eval:(() => { const play = document.querySelector(\"footer .play\"); play.click();"
              " const on = playing; play.click(); return on && !playing; })()"},
             "#t=30&follow=1&distance=25");
  if (values.empty()) GTEST_SKIP() << "Chromium is not installed (chromium)";
  EXPECT_EQ(values[0], 30);
  EXPECT_EQ(values[1], 25);
  EXPECT_EQ(values[2], "truth");
  EXPECT_LT(values[3].get<double>(), 0.05);
  EXPECT_THAT(values[4].get<std::string>(), HasSubstr("ekf: error "));
  EXPECT_GT(values[5].get<int>(), 48);
  EXPECT_EQ(values[6], true);
}

TEST_F(ViewCommand, FiltersHideLandmarks) {
  ASSERT_EQ(view().code, 0);
  const std::string all = folder_ / "all.png", none = folder_ / "none.png";
  const auto values =
      browse({"shot:" + all, "eval:(scene.layers[0].shown = false, redraw(), 1)", "shot:" + none,
              "clickon:waymark.pixelOf(scene.layers[0].uids[0])", "eval:waymark.selected()"});
  if (values.empty()) GTEST_SKIP() << "Chromium is not installed (chromium)";
  EXPECT_GT(compare(all, none).different, 0.001);
  EXPECT_TRUE(values[4].is_null());
}

/// One landmark of each type of a street, in metres; directions in radians clockwise from north.
constexpr const char* kStreet =
    "type,uid,x,y,direction,facing,orientation,opening_angle,side,length,width,height,diameter\n"
    "wall,w,0,0,1.5707963,,,,,10,,4,\n"        // faces east, so it runs north
    "wall_corner,c,10,0,0,,,1.5707963,,,,,\n"  // into the open: north
    "wall_end,e,20,0,0,,,,1,,,,\n"
    "traffic_sign,s,30,0,,3.1415926,,,,,,2.5,\n"
    "door,d,0,20,,,0.7853982,,,,0.9,,\n"  // along north-east
    "building,b,20,20,,,0,,,,,9,14\n"
    "lane_mark,l,40,20,,,1.5707963,,,6,0.2,,\n"
    "pole,p,50,0,,,,,,,,6,0.2\n"
    "wall,u,50,20,,,,,,8,,3,\n";  // its direction is unknown

TEST_F(ViewCommand, WallsDoorsSignsAndBuildingsHaveTheirShapes) {
  const std::string map = folder_ / "street.gpkg";
  write_text(folder_ / "street.csv", kStreet);
  ASSERT_EQ(waymark({"import", folder_ / "street.csv", "-o", map, "--map-crs", "local"}).code, 0);
  ASSERT_EQ(waymark({"view", map, "-o", page_, "--title",
                     "A street with a title that is so long that it needs several lines of the heading"})
                .code,
            0);
  // Returns west, south, low, east, north, high of a landmark's boxes about its position, in centimetres.
  const std::string box =
      "(uid => { const one = findLandmark(uid), lo = [1e9, 1e9, 1e9], hi = [-1e9, -1e9, -1e9];"
      " for (const b of formOf(one.layer, one.index)) visitBox(b, p => p.forEach((v, k) => {"
      " lo[k] = Math.min(lo[k], v); hi[k] = Math.max(hi[k], v); })); return [...lo, ...hi].map(v => "
      "Math.round(100 * v)); })";
  std::vector<std::string> steps;
  const std::vector<std::string> uids{"w", "c", "e", "s", "d", "b", "l"};
  for (const std::string& uid : uids) steps.push_back("eval:" + box + "(\"" + uid + "\")");
  for (const std::string& uid : std::vector<std::string>{"w", "c", "e", "s", "d", "b", "l", "p", "u"}) {
    // Each is looked at from near, as a user would choose it.
    steps.push_back("eval:(() => { const one = findLandmark(\"" + uid +
                    "\"), n = one.layer.numbers, at = one.index * LANDMARK.size; eye.x = n[at];"
                    " eye.y = n[at + 1]; eye.distance = 25; eye.azimuth = 0.6; redraw(); return 1; })()");
    steps.push_back("clickon:waymark.pixelOf(\"" + uid + "\")");
    steps.push_back("eval:waymark.selected()");
  }
  steps.push_back(
      "eval:(() => { const h = document.querySelector(\"header\").getBoundingClientRect(), l = "
      "document.querySelector(\".legend\").getBoundingClientRect();"
      " return [h.bottom <= l.top, h.height > 60, l.bottom <= innerHeight]; })()");
  steps.push_back("errors");
  const auto values = browse(steps);
  if (values.empty()) GTEST_SKIP() << "Chromium is not installed (chromium)";
  EXPECT_EQ(values[0], Json::parse("[-12,-500,-30,0,500,400]"));
  // Wings of 60 cm at 45 degrees to the north-east and north-west, 12 cm thick, as high as no type says.
  EXPECT_EQ(values[1], Json::parse("[-51,-8,-30,51,42,250]"));
  EXPECT_EQ(values[2], Json::parse("[0,-12,-30,60,0,250]"))
      << "who looks south at the face has the left in the east";
  EXPECT_EQ(values[3], Json::parse("[-30,-8,-20,30,4,280]"));
  EXPECT_EQ(values[4][3].get<int>() - values[4][0].get<int>(),
            values[4][4].get<int>() - values[4][1].get<int>())
      << "diagonal";
  EXPECT_NEAR(values[4][3].get<int>(), 46, 4);  // 0.53 m to the jambs' ends, and 0.12 m of thickness
  EXPECT_EQ(values[5], Json::parse("[-620,-620,-50,620,620,900]")) << "a square as large as the circle";
  EXPECT_EQ(values[6], Json::parse("[-300,-10,0,300,10,3]"));
  const std::vector<std::string> clicked{"w", "c", "e", "s", "d", "b", "l", "p", "u"};
  for (std::size_t i = 0; i < clicked.size(); ++i) EXPECT_EQ(values[uids.size() + 3 * i + 2], clicked[i]);
  EXPECT_EQ(values[values.size() - 2], Json::parse("[true,true,true]")) << "heading above legend";
  EXPECT_THAT(values.back(), IsEmpty());
}

TEST_F(ViewCommand, TheReportsTableAndMapAnswerEachOther) {
  ASSERT_EQ(waymark({"report", map_, "-o", page_}).code, 0);
  const auto values = browse(
      {"eval:document.querySelector(\".landmarks tbody tr .go\").click()",
       "eval:document.querySelectorAll(\".chosen\").length",
       "eval:document.querySelector(\".map svg > g > g\").getAttribute(\"transform\")",
       "eval:document.querySelectorAll(\".landmarks .sort\")[2].click()",
       "eval:[...document.querySelectorAll(\".landmarks tbody tr\")].map(row => "
       "parseFloat(row.cells[2].textContent))",
       "eval:(() => { const one = document.querySelector(\".controls input\"); one.value = 1; one.oninput();"
       " return document.querySelector(\".controls > output\").textContent; })()",
       "errors", "requests"});
  if (values.empty()) GTEST_SKIP() << "Chromium is not installed (chromium)";
  EXPECT_EQ(values[1], 2);  // the row and the symbol
  EXPECT_THAT(values[2].get<std::string>(), HasSubstr("scale(4)"));
  const auto sizes = values[4].get<std::vector<double>>();
  EXPECT_GT(sizes.size(), 5u);
  EXPECT_TRUE(std::is_sorted(sizes.rbegin(), sizes.rend()));
  EXPECT_EQ(values[5], fmt::format("{0} of {0} shown", made_rocks().size()));  // all have confidence 1
  EXPECT_THAT(values[6], IsEmpty());
  EXPECT_EQ(values[7].size(), 1u);
}

TEST_F(ViewCommand, AFolderThatIsNoSceneIsNamed) {
  const Outcome outcome = waymark({"view", folder_.path().string(), "-o", page_});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("the folder is no simulated scene: it has no truth/landmarks.csv"));
}

TEST_F(ViewCommand, ASceneShowsItsTruth) {
  std::filesystem::create_directories(folder_ / "scene/truth");
  write_text(folder_ / "scene/truth/landmarks.csv",
             "type,x,y,z,radius,height\nrock,1,2,0,0.5,0.6\nrock,5,2,0,1,1\n");
  std::filesystem::copy_file(folder_ / "dem.tif", folder_ / "scene/dem.tif");
  const Outcome outcome = waymark({"view", folder_ / "scene", "-o", page_});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(text_of(page_), HasSubstr(R"("total":2)"));
  EXPECT_THAT(text_of(page_), HasSubstr(R"("caption":"shaded relief")"));
}

TEST_F(ViewCommand, AnOrthophotoElsewhereIsNamed) {
  MadeDem photo{.columns = 10, .rows = 10};
  photo.crs = "";
  photo.geotransform = {5000, 1, 0, 5000, 0, -1};
  photo.cell_type = GDT_Byte;
  const Outcome outcome = view({"--orthophoto", make_dem(folder_ / "far.tif", photo)});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("the orthophoto does not overlap the view"));
  EXPECT_THAT(outcome.err, HasSubstr("far.tif"));
}

TEST_F(ViewCommand, AnOrthophotoLiesOnTheTerrain) {
  MadeDem photo{.columns = 60, .rows = 60};
  photo.crs = "";
  photo.geotransform = {-30, 1, 0, 30, 0, -1};
  photo.cell_type = GDT_Byte;
  photo.height = [](int column, int row) { return (column / 10 + row / 10) % 2 ? 250.0 : 5.0; };
  photo.nodata = 0;
  ASSERT_EQ(view({"--orthophoto", make_dem(folder_ / "photo.tif", photo)}).code, 0);
  EXPECT_THAT(text_of(page_), HasSubstr(R"("caption":"orthophoto")"));
}

TEST_F(ViewCommand, ATrackThatIsNoTrackIsNamed) {
  const Outcome outcome = view({"--track", folder_ / "rocks.csv"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("rocks.csv"));
}

}  // namespace
}  // namespace waymark::test
