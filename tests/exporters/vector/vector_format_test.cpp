// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/vector_format.hpp"

#include <gmock/gmock.h>

#include "tests/exporters/small_map.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

using test::error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(VectorFormat, FollowsTheExtension) {
  EXPECT_EQ(vector_format("a/b.geojson", "").driver, "GeoJSON");
  EXPECT_EQ(vector_format("b.GPKG", "").driver, "GPKG");
  EXPECT_EQ(vector_format("b.kml", "").driver, "KML");
  EXPECT_EQ(vector_format("b.shp", "").driver, "ESRI Shapefile");
  EXPECT_EQ(vector_format("b.fgb", "").driver, "FlatGeobuf");
  EXPECT_EQ(vector_format("b.xml", "").driver, "GML");  // and not PDS4, a raster format
}

TEST(VectorFormat, NameOutweighsExtensionInAnyCase) {
  EXPECT_EQ(vector_format("b.geojson", "flatgeobuf").driver, "FlatGeobuf");
}

TEST(VectorFormat, KnowsWhatFormatsHold) {
  EXPECT_TRUE(vector_format("b.csv", "").is_table);
  EXPECT_TRUE(vector_format("b.csv", "").one_layer);
  EXPECT_FALSE(vector_format("b.gpkg", "").one_layer);
  EXPECT_TRUE(vector_format("b.kml", "").only_wgs84);
  EXPECT_FALSE(vector_format("b.geojson", "").only_wgs84);
  EXPECT_FALSE(vector_format("PG:dbname=maps", "PostgreSQL").is_file);
}

TEST(VectorFormat, UnknownNameSuggestsTheNearest) {
  const std::string message = error_of([] { vector_format("b.xyz", "GeoJSN"); });
  EXPECT_THAT(message, HasSubstr("this GDAL has no vector format 'GeoJSN' to write"));
  EXPECT_THAT(message, HasSubstr("did you mean GeoJSON?"));
}

TEST(VectorFormat, NameLikeNoOtherPointsToTheList) {
  EXPECT_THAT(error_of([] { vector_format("b", "quixotically"); }), HasSubstr("`ogrinfo --formats` lists"));
}

TEST(VectorFormat, UnknownExtensionSaysWhatToDo) {
  const std::string message = error_of([] { vector_format("out/b.geojsom", ""); });
  EXPECT_THAT(message, HasSubstr("no vector format has the extension .geojsom\n  out/b.geojsom"));
  EXPECT_THAT(message, HasSubstr("did you mean .geojson? name the format with -of"));
}

TEST(VectorFormat, NameWithoutExtensionSaysWhatToDo) {
  EXPECT_THAT(error_of([] { vector_format("out/b", ""); }),
              HasSubstr("cannot recognise the format of b: its name has no extension"));
}

TEST(OutputCrs, IsTheMapsUnlessTheFormatMeansAnother) {
  const Crs utm = Crs::from_text("EPSG:32719");
  EXPECT_EQ(output_crs(vector_format("b.fgb", ""), utm, "", "map.gpkg").id(), "EPSG:32719");
  EXPECT_EQ(output_crs(vector_format("b.geojson", ""), utm, "", "map.gpkg").id(), "EPSG:4326");
  EXPECT_EQ(output_crs(vector_format("b.geojson", ""), utm, "EPSG:32719", "map.gpkg").id(), "EPSG:32719");
}

TEST(OutputCrs, KmlOnMarsSaysWhatKeepsTheCrs) {
  const std::string message = error_of(
      [] { output_crs(vector_format("b.kml", ""), Crs::from_text("IAU_2015:49900"), "", "mars.gpkg"); });
  EXPECT_THAT(message, HasSubstr("KML holds positions on Earth only; this map is on Mars"));
  EXPECT_THAT(message, HasSubstr("mars.gpkg: IAU_2015:49900"));
  EXPECT_THAT(message, HasSubstr("write .gpkg, .fgb or .shp"));
}

TEST(OutputCrs, LocalMetresAreNotOnEarth) {
  EXPECT_THAT(error_of([] { output_crs(vector_format("b.geojson", ""), Crs::local(), "", "map.gpkg"); }),
              HasSubstr("this map is in local metres"));
}

TEST(OutputCrs, AnotherBodyIsRefusedByName) {
  const std::string message = error_of([] {
    output_crs(vector_format("b.fgb", ""), Crs::from_text("IAU_2015:49900"), "EPSG:4326", "mars.gpkg");
  });
  EXPECT_THAT(message, HasSubstr("IAU_2015:49900"));
  EXPECT_THAT(message, HasSubstr("EPSG:4326"));
}

TEST(OutputCrs, KmlInMetresIsRefused) {
  EXPECT_THAT(error_of([] {
                output_crs(vector_format("b.kml", ""), Crs::from_text("EPSG:4326"), "EPSG:32719", "map.gpkg");
              }),
              HasSubstr("KML holds EPSG:4326 only, not EPSG:32719\n  --crs EPSG:32719\n  leave out --crs"));
}

TEST(FittingNames, KeepShortEndingsAndStayUnique) {
  const VectorFormat shapefile = vector_format("b.shp", "");
  EXPECT_THAT(shorten_names(shapefile, {"uid", "prominence", "prominence_sd", "prominence_low",
                                        "saddle_elevation", "saddle_elevations"}),
              ElementsAre("uid", "prominence", "promine_sd", "promin_low", "saddle_ele", "saddle_el2"));
  EXPECT_THAT(shorten_names(vector_format("b.csv", ""), {"saddle_elevation"}),
              ElementsAre("saddle_elevation"));
}

}  // namespace
}  // namespace waymark::test
