// SPDX-License-Identifier: Apache-2.0
// Records of maps and rasters, checked by what STAC 1.1.0 and its extensions demand.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>
#include <vector>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

class Stac : public testing::Test {
 protected:
  std::string rocks(const std::string& crs) const {
    write_text(folder_ / "rocks.csv", "uid,x,y,z,radius\na,10,20,0,0.5\nb,12,21.5,0,0.7\n");
    const std::string map = folder_ / "rocks.gpkg";
    const Outcome made =
        waymark({"import", folder_ / "rocks.csv", "-o", map, "--type", "rock", "--map-crs", crs});
    EXPECT_EQ(made.code, 0) << made.err;
    return map;
  }
  Json record(const std::string& name) const { return Json::parse(text_of(folder_ / name)); }
  /// Rules of item.json and of the extensions' schemas, in our words.
  static void expect_valid_item(const Json& item) {
    EXPECT_EQ(item["type"], "Feature");
    EXPECT_EQ(item["stac_version"], "1.1.0");
    EXPECT_FALSE(item["id"].get<std::string>().empty());
    EXPECT_TRUE(item["links"].is_array());
    const Json& properties = item["properties"];
    if (properties.at("datetime").is_null()) {
      EXPECT_TRUE(properties.contains("start_datetime") && properties.contains("end_datetime"));
    } else {
      EXPECT_THAT(properties["datetime"].get<std::string>(),
                  testing::MatchesRegex("[0-9-]{10}T[0-9:.]{8,12}Z"));
    }
    EXPECT_EQ(item.at("geometry").is_null(), !item.contains("bbox"));
    if (item.contains("bbox")) {
      EXPECT_EQ(item["bbox"].size(), 4U);
    }
    const auto uses = [&](const std::string& prefix) {
      for (const auto& [name, value] : properties.items())
        if (name.starts_with(prefix)) return true;
      return false;
    };
    std::string extensions;
    for (const Json& extension : item["stac_extensions"]) extensions += extension.get<std::string>() + " ";
    for (const auto& [prefix, name] : {std::pair("proj:", "/projection/v2.0.0/"),
                                       {"ssys:", "/ssys/v1.1.0/"},
                                       {"view:", "/view/v1.1.0/"},
                                       {"processing:", "/processing/v1.2.0/"}})
      EXPECT_EQ(uses(prefix), extensions.find(name) != std::string::npos) << prefix;
    EXPECT_THAT(extensions, HasSubstr("/file/v2.1.0/"));
    ASSERT_FALSE(item["assets"].empty());
    for (const Json& asset : item["assets"]) {
      EXPECT_TRUE(asset["href"].is_string() && asset["type"].is_string() && asset["roles"].is_array());
      EXPECT_THAT(asset["file:checksum"].get<std::string>(), testing::MatchesRegex("1220[0-9a-f]{64}"));
    }
  }

  TempFolder folder_;
};

TEST_F(Stac, ItemOfAMap) {
  const std::string map = rocks("IAU_2015:49900");
  const Outcome made = waymark({"stac", map, "-o", folder_ / "item.json"});
  ASSERT_EQ(made.code, 0) << made.err;
  const Json item = record("item.json");
  expect_valid_item(item);
  EXPECT_EQ(item["id"], "rocks");
  EXPECT_EQ(item["bbox"], (Json{10, 20, 12, 21.5}));
  EXPECT_EQ(item["geometry"]["type"], "Polygon");
  EXPECT_EQ(item["geometry"]["coordinates"][0][0], item["geometry"]["coordinates"][0].back());
  const Json& properties = item["properties"];
  EXPECT_EQ(properties["proj:code"], "IAU_2015:49900");
  EXPECT_THAT(properties["proj:wkt2"].get<std::string>(), HasSubstr("Mars"));
  EXPECT_EQ(properties["ssys:targets"], Json::array({"Mars"}));
  EXPECT_EQ(properties["ssys:target_class"], "planet");
  EXPECT_EQ(properties["waymark:landmarks"], (Json{{"rock", 2}}));
  EXPECT_THAT(properties["processing:lineage"].get<std::string>(), HasSubstr("waymark import"));
  EXPECT_THAT(properties["processing:software"]["Waymark"].get<std::string>(),
              testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+.*"));
  const Json& asset = item["assets"]["map"];
  EXPECT_EQ(asset["href"], "./rocks.gpkg");
  EXPECT_EQ(asset["file:size"], std::filesystem::file_size(map));
  EXPECT_EQ("1220" + bash("sha256sum < " + map).out.substr(0, 64), asset["file:checksum"]);
}

TEST_F(Stac, AMapAcrossTheAntimeridianIsDivided) {
  write_text(folder_.path() / "far.csv", "x,y,radius,height\n179.9,20,1,1\n-179.8,21,1,1\n");
  const std::string map = folder_ / "far.gpkg";
  ASSERT_EQ(
      waymark({"import", folder_ / "far.csv", "-o", map, "--type", "rock", "--map-crs", "EPSG:4326"}).code,
      0);
  ASSERT_EQ(waymark({"stac", map, "-o", folder_ / "item.json"}).code, 0);
  const Json item = record("item.json");
  expect_valid_item(item);
  EXPECT_NEAR(item["bbox"][0], 179.9, 1e-9);
  EXPECT_NEAR(item["bbox"][2], -179.8, 1e-9);
  EXPECT_EQ(item["geometry"]["type"], "MultiPolygon");
}

TEST_F(Stac, LocalMapsHaveNoPlaceOnABody) {
  ASSERT_EQ(waymark({"stac", rocks("local"), "-o", folder_ / "item.json"}).code, 0);
  const Json item = record("item.json");
  expect_valid_item(item);
  EXPECT_TRUE(item["geometry"].is_null());
  EXPECT_TRUE(item["properties"]["proj:code"].is_null());
  EXPECT_EQ(item["properties"]["proj:bbox"], (Json{10, 20, 12, 21.5}));
  EXPECT_FALSE(item["properties"].contains("ssys:targets"));
}

TEST_F(Stac, CollectionOfAMapAndARaster) {
  const std::string map = rocks("EPSG:4326"), dem = make_dem(folder_ / "dem.tif", hills(40, 30));
  const std::string out = folder_ / "catalogue";
  const Outcome made = waymark({"stac", map, dem, "-o", out, "--collection", "site", "--datetime",
                                "2026-11-24T10:00:00Z", "--href", "https://example.org/maps"});
  ASSERT_EQ(made.code, 0) << made.err;
  const Json collection = record("catalogue/collection.json");
  for (const char* field : {"type", "stac_version", "id", "description", "license", "extent", "links"})
    EXPECT_TRUE(collection.contains(field)) << field;
  EXPECT_EQ(collection["type"], "Collection");
  EXPECT_EQ(collection["extent"]["spatial"]["bbox"].size(), 3U);  // of all, then of each
  EXPECT_EQ(collection["extent"]["temporal"]["interval"],
            (Json::array({Json::array({"2026-11-24T10:00:00Z", "2026-11-24T10:00:00Z"})})));
  std::vector<std::string> items;
  for (const Json& link : collection["links"])
    if (link["rel"] == "item") items.push_back(link["href"]);
  EXPECT_THAT(items, testing::ElementsAre("./rocks.json", "./dem.json"));

  const Json raster = record("catalogue/dem.json");
  expect_valid_item(raster);
  expect_valid_item(record("catalogue/rocks.json"));
  EXPECT_EQ(raster["collection"], "site");
  EXPECT_EQ(raster["properties"]["proj:shape"], (Json{30, 40}));
  const Json& transform = raster["properties"]["proj:transform"];
  const Json& box = raster["properties"]["proj:bbox"];
  EXPECT_EQ(transform[2], box[0]);
  EXPECT_EQ(transform[5], box[3]);
  EXPECT_NEAR(box[2].get<double>(), box[0].get<double>() + 40 * transform[0].get<double>(), 1e-9);
  EXPECT_EQ(raster["assets"]["raster"]["href"], "https://example.org/maps/dem.tif");
  EXPECT_THAT(raster["assets"]["raster"]["type"].get<std::string>(), HasSubstr("image/tiff"));
}

TEST_F(Stac, AnItemInTheWorkingFolderHasNoFolderInItsName) {
  rocks("EPSG:32633");
  const Outcome made = bash("cd " + folder_.path().string() + " && $WAYMARK stac rocks.gpkg -o rocks.json");
  ASSERT_EQ(made.code, 0) << made.err;
  expect_valid_item(record("rocks.json"));
  EXPECT_EQ(record("rocks.json")["assets"]["map"]["href"], "./rocks.gpkg");
}

TEST_F(Stac, Pds4LabelsAreFilledAndReadBack) {
  const std::string map = rocks("IAU_2015:49900"), label = folder_ / "rocks.xml";
  const Outcome bare = waymark({"export", map, folder_ / "bare.xml", "-of", "PDS4"});
  ASSERT_EQ(bare.code, 0) << bare.err;
  EXPECT_THAT(bare.err, HasSubstr("LOGICAL_IDENTIFIER"));
  const Outcome made =
      waymark({"export", map, label, "-of", "PDS4", "--label", "LOGICAL_IDENTIFIER=urn:nasa:pds:b:c:rocks",
               "--label", "INVESTIGATION_AREA_NAME=Made <mission>", "--label",
               "INVESTIGATION_AREA_LID_REFERENCE=urn:nasa:pds:context:investigation:made", "--label",
               "OBSERVING_SYSTEM_NAME=Made rover"});
  ASSERT_EQ(made.code, 0) << made.err;
  const std::string text = text_of(label);
  EXPECT_THAT(text, testing::Not(HasSubstr("${")));
  EXPECT_THAT(text, HasSubstr("<logical_identifier>urn:nasa:pds:b:c:rocks</logical_identifier>"));
  EXPECT_THAT(text, HasSubstr("<title>Landmarks of rocks: rock</title>"));
  EXPECT_THAT(text, HasSubstr("<name>Made &lt;mission&gt;</name>"));
  EXPECT_THAT(text, HasSubstr("<name>Mars</name>"));
  EXPECT_THAT(text, HasSubstr("<type>Planet</type>"));
  EXPECT_THAT(text, HasSubstr("context:target:planet.mars"));
  EXPECT_THAT(text, HasSubstr("<records>2</records>"));

  const std::string back = folder_ / "back.gpkg";
  const Outcome read = waymark(
      {"import", label, "--from", "ogr", "-o", back, "--type", "rock", "--map-crs", "IAU_2015:49900"});
  ASSERT_EQ(read.code, 0) << read.err;
  const auto columns = [](const std::string& of) {  // unknown heights and accuracies too
    return bash("$WAYMARK query " + of + " --format csv").out;
  };
  EXPECT_THAT(columns(map), HasSubstr(",,,,"));
  EXPECT_THAT(columns(map), HasSubstr("21.5"));
  EXPECT_EQ(columns(back), columns(map));
  EXPECT_EQ(waymark({"export", map, label, "--overwrite", "-of", "PDS4", "--label", "COLOUR=red"}).code, 2);
  const Outcome urn =
      waymark({"export", map, label, "--overwrite", "-of", "PDS4", "--label", "LOGICAL_IDENTIFIER=rocks"});
  EXPECT_EQ(urn.code, 2);
  EXPECT_THAT(urn.err, HasSubstr("'rocks' is no logical identifier"));
  EXPECT_THAT(waymark({"export", map, folder_ / "a.geojson", "--label", "TITLE=x"}).err,
              HasSubstr("GeoJSON has no label"));
}

// PDS4 labels have no false easting, and planetocentric latitudes mean a sphere.
TEST_F(Stac, Pds4LabelsPlaceLandmarksOfProjectionsWhereTheyAre) {
  write_text(folder_ / "utm.csv",
             "uid,x,y,radius,height\nr1,731919.8,4004847.7,1,1\nr2,762542.5,4037374,1,1\n");
  const std::string map = folder_ / "utm.gpkg", label = folder_ / "utm.xml";
  ASSERT_EQ(
      waymark({"import", folder_ / "utm.csv", "-o", map, "--type", "rock", "--map-crs", "EPSG:32616"}).code,
      0);
  const Outcome made = waymark({"export", map, label, "-of", "PDS4"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("without false origin"));
  EXPECT_THAT(text_of(label), HasSubstr("<cart:latitude_type>Planetographic<"));
  const auto degrees = [&](const std::string& file) {
    std::vector<std::pair<double, double>> found;
    const std::string text = bash("ogr2ogr -q -f CSV -t_srs +proj=longlat -lco GEOMETRY=AS_XY /vsistdout/ '" +
                                  file + "' 2>/dev/null")
                                 .out;
    std::istringstream lines(text);
    std::string line, x, y;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      std::istringstream cells(line);
      std::getline(cells, x, ','), std::getline(cells, y, ',');
      found.emplace_back(std::stod(x), std::stod(y));
    }
    std::ranges::sort(found);
    return found;
  };
  ASSERT_EQ(waymark({"export", map, folder_ / "utm.fgb"}).code, 0);
  const auto is = degrees(label), wanted = degrees(folder_ / "utm.fgb");
  ASSERT_EQ(wanted.size(), 2u);
  ASSERT_EQ(is.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(is[i].first, wanted[i].first, 1e-7);
    EXPECT_NEAR(is[i].second, wanted[i].second, 1e-7);
  }
}

TEST_F(Stac, BadRequestsAreRefused) {
  const std::string map = rocks("EPSG:4326");
  const auto expect_refusal = [](const std::vector<std::string>& words, int code, const std::string& text) {
    const Outcome said = waymark(words);
    EXPECT_EQ(said.code, code) << text;
    EXPECT_THAT(said.err, HasSubstr(text));
  };
  expect_refusal({"stac", map, map, "-o", folder_ / "c"}, 2, "the id 'rocks' is taken");
  expect_refusal({"stac", map, folder_ / "a.tif", "-o", folder_ / "i.json"}, 2, "cannot share the item");
  expect_refusal({"stac", map, "-o", folder_ / "i.json", "--datetime", "today"}, 2, "'today' is not a time");
  expect_refusal({"stac", map, "-o", folder_ / "i.json", "--collection", "c"}, 2, "the output is one item");
  expect_refusal({"stac", folder_ / "rocks.csv", "-o", folder_ / "i.json"}, 1, "neither a map nor a raster");
  expect_refusal({"stac", map, folder_ / "rocks.csv", "-o", folder_ / "c"}, 2, "the id 'rocks' is taken");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "c"));
}

}  // namespace
}  // namespace waymark::test
