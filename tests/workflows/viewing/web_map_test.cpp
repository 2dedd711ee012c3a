// SPDX-License-Identifier: Apache-2.0
// The folder of a web map: its bytes, its style and page, and what is refused.
#include "workflows/viewing/web_map.hpp"

#include <gmock/gmock.h>
#include <sys/mount.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "tests/support/message_of.hpp"
#include "tests/workflows/viewing/web_map_fixture.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Json = nlohmann::json;

TEST_F(WebMap, BytesDoNotDependOnThreads) {
  geodb::MapContents contents = made_map("EPSG:32632", 500000, 5.2e6, 3000, 900);
  contents.layers = made_areas(500000, 5.2e6, 1);
  const std::string map = write(contents);
  std::map<std::string, std::string> first;
  for (const int threads : {1, 3}) {
    make_web_map({.map = map, .output = site(), .threads = threads});
    for (const auto& entry : fs::directory_iterator(site())) {
      const std::string name = entry.path().filename();
      const auto [known, is_new] = first.try_emplace(name, text(name));
      EXPECT_EQ(known->second, text(name)) << name;
    }
  }
  EXPECT_EQ(first.size(), 7u);
}

TEST_F(WebMap, TheStyleHasTheColoursOfTheTypesAndTheScaleOfTheBody) {
  const geodb::MapContents contents = made_map("IAU_2015:49900", 77, 18, 1, 60);
  make_web_map({.map = write(contents), .output = site(), .title = "Jezero <1>"});
  const Json style = Json::parse(text("style.json"));
  const Json& about = style["metadata"]["waymark"];
  EXPECT_EQ(about["body"], "Mars");
  EXPECT_EQ(about["radius"], contents.crs.body().equatorial_radius);
  EXPECT_EQ(about["plane"], false);
  EXPECT_EQ(style["name"], "Jezero <1>");
  EXPECT_THAT(text("index.html"), HasSubstr("<title>Jezero &lt;1&gt;</title>"));
  int found = 0;
  for (const Json& layer : style["layers"])
    if (layer["type"] == "circle") {
      const LandmarkType* type = contents.types.find(layer["source-layer"].get<std::string>());
      const Json& paint = layer["paint"];
      EXPECT_TRUE(paint["circle-color"] == type->colour);
      ++found;
    }
  EXPECT_EQ(found, 3);
}

TEST_F(WebMap, AMapWithoutLandmarksIsNamed) {
  const std::string map = write(made_map("local", 0, 0, 1, 0));
  EXPECT_THAT(message_of([&] { make_web_map({.map = map, .output = site()}); }),
              HasSubstr("the map has no landmarks to show"));
  EXPECT_FALSE(fs::exists(site()));
}

TEST_F(WebMap, OtherPeoplesFilesAreKept) {
  const std::string map = write(made_map("local", 0, 0, 1, 9));
  make_web_map({.map = map, .output = site()});
  make_web_map({.map = map, .output = site()});  // a web map is replaced
  fs::copy_file(map, fs::path(site()) / "thesis.gpkg");
  EXPECT_THAT(message_of([&] { make_web_map({.map = map, .output = site()}); }),
              HasSubstr("the folder holds files that are no part of a web map, such as thesis.gpkg"));
  EXPECT_THAT(message_of([&] { make_web_map({.map = map, .output = map}); }),
              HasSubstr("the output is a file, and a web map is a folder"));
}

TEST_F(WebMap, ALibraryOfAnotherVersionIsRefused) {
  const std::string map = write(made_map("local", 0, 0, 1, 9));
  fs::create_directories(folder() / "lib");
  EXPECT_THAT(message_of([&] {
                make_web_map({.map = map, .output = site(), .assets = (folder() / "lib").string()});
              }),
              HasSubstr("maplibre-gl.js"));
  fs::copy_file(map, folder() / "lib/maplibre-gl.js");
  EXPECT_THAT(message_of([&] {
                make_web_map({.map = map, .output = site(), .assets = (folder() / "lib").string()});
              }),
              HasSubstr("maplibre-gl.js is not the version that the page is made for"));
}

TEST_F(WebMap, ATerrainThatIsNoDemAndAZoomBeyondAllAreNamed) {
  const std::string map = write(made_map("local", 0, 0, 1, 9));
  EXPECT_THAT(message_of([&] { make_web_map({.map = map, .output = site(), .dem = {map}}); }),
              HasSubstr("no elevation model of this map's body and kind of CRS could be read"));
  EXPECT_THAT(message_of([&] { make_web_map({.map = map, .output = site(), .max_zoom = 23}); }),
              HasSubstr("zoom 23 is finer than any map tile"));
}

TEST_F(WebMap, AFullDiskLeavesTheOlderMap) {
  const fs::path disk = folder() / "disk";
  fs::create_directories(disk);
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=300k") != 0)
    GTEST_SKIP() << "a small tmpfs can only be mounted by root";
  const std::string small = write(made_map("local", 0, 0, 100, 30)), target = (disk / "site").string();
  make_web_map({.map = small, .output = target});
  const std::string before = read_text(disk / "site/landmarks.pmtiles", "a file");
  const std::string large = write(made_map("local", 0, 0, 100, 5000));
  const std::string message = message_of([&] { make_web_map({.map = large, .output = target}); });
  EXPECT_THAT(message, HasSubstr("the disk is full"));
  EXPECT_EQ(read_text(disk / "site/landmarks.pmtiles", "a file"), before);
  ::umount2(disk.c_str(), MNT_DETACH);
}

}  // namespace
}  // namespace waymark::test
