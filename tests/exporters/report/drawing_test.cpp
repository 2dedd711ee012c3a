// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "exporters/report/histogram.hpp"
#include "exporters/report/map_markers.hpp"
#include "exporters/report/map_view.hpp"
#include "tests/exporters/small_map.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Histogram, CountsEveryValueOnce) {
  const Histogram h = histogram_of({0, 1, 2, 3, 4, 5, 6}, Scale::interval);
  EXPECT_THAT(h.counts, ElementsAre(1, 1, 1, 1, 1, 2));  // the last bin includes its upper edge
  EXPECT_FALSE(h.logarithmic);
}

TEST(Histogram, WideRatiosAreLogarithmic) {
  EXPECT_TRUE(histogram_of({20, 50, 6000}, Scale::ratio).logarithmic);
  EXPECT_FALSE(histogram_of({20, 50, 500}, Scale::ratio).logarithmic);
  EXPECT_FALSE(histogram_of({0, 50, 6000}, Scale::ratio).logarithmic);
  EXPECT_FALSE(histogram_of({20, 50, 6000}, Scale::interval).logarithmic);
}

TEST(Histogram, EqualValuesAreOneBin) {
  EXPECT_THAT(histogram_of({5, 5, 5}, Scale::ratio).counts, ElementsAre(3));
}

TEST(RoundLength, IsOneTwoOrFive) {
  EXPECT_EQ(round_length(9.9), 5);
  EXPECT_EQ(round_length(4.9), 2);
  EXPECT_EQ(round_length(1900), 1000);
  EXPECT_DOUBLE_EQ(round_length(0.2), 0.2);
}

TEST(MapView, KeepsTheProportionsOfTheGround) {
  const MapView view = view_of(Crs::from_text("EPSG:4326"), {10, 59, 12, 61});  // cos 60 = 1/2
  EXPECT_NEAR(view.width, 500, 1e-9);
  EXPECT_NEAR(view.height, 1000, 1e-9);
  EXPECT_NEAR(view.metres_per_unit(), 222.39, 0.01);
}

TEST(MapView, ShowsTheSideOfTheAntimeridianWithTheLandmarks) {
  const auto extent = [](std::initializer_list<double> longitudes, const char* crs) {
    LandmarkType post;
    post.name = "post";
    std::vector<LandmarkSection> sections;
    for (const double x : longitudes)
      sections.push_back(landmark_section(post, [x](const std::function<void(Landmark &&)>& take) {
        Landmark landmark;
        landmark.position.xyz << x, 10, 0;
        take(std::move(landmark));
      }));
    return *extent_of(sections, Crs::from_text(crs));
  };
  const Extent across = extent({179.5, -179.5, -179.9}, "EPSG:4326");
  EXPECT_NEAR(across.west, 179.5, 0.1);
  EXPECT_NEAR(across.east, 180.5, 0.1);
  EXPECT_NEAR(extent({-5, 5}, "EPSG:4326").width(), 10, 1) << "across Greenwich";
  EXPECT_NEAR(extent({-300, 400}, "EPSG:32633").west, -800, 1) << "metres are no longitudes";
}

TEST(MapView, LongitudesAreUnwrapped) {
  const MapView view = view_of(Crs::from_text("EPSG:4326"), {179, -1, 181, 1});
  EXPECT_EQ(view.unwrap(-179.5), 180.5);
}

TEST(PositionText, SpeaksTheLanguageOfTheCrs) {
  EXPECT_EQ(position_text(Crs::from_text("EPSG:4326"), 289.9875, -32.65),
            "32.6500\u00b0\u00a0S 70.0125\u00b0\u00a0W");
  EXPECT_EQ(position_text(Crs::from_text("IAU_2015:49900"), 226.2, 18.65),
            "18.6500\u00b0\u00a0N 226.2000\u00b0\u00a0E");
  EXPECT_EQ(position_text(Crs::local(), 1, 2), "x\u00a01.00 y\u00a02.00");
}

TEST(NorthArrow, TurnsWithThePolarMap) {
  // South of the pole along 90 E in north polar stereographic (EPSG:3413, central meridian 45 W): up is not
  // north.
  const MapView view = view_of(Crs::from_text("EPSG:3413"), {999000, -1000, 1001000, 1000});
  EXPECT_THAT(svg_north_arrow(view), HasSubstr("rotate(-90.0)"));
}

/// Returns the section of the type of the first landmark.
LandmarkSection section_of(const geodb::MapContents& map) {
  return landmark_section(map.types[map.landmarks[0].type], [&](const auto& take) {
    for (Landmark landmark : map.landmarks) take(std::move(landmark));
  });
}

TEST(LandmarkSections, HoldTheForemostAndTheValuesOfAll) {
  const geodb::MapContents map = test::three_summits("EPSG:4326", -70, -32, 0.1);
  const LandmarkSection section = landmark_section(
      map.types[map.landmarks[0].type],
      [&](const auto& take) {
        for (auto landmark = map.landmarks.rbegin(); landmark != map.landmarks.rend(); ++landmark)
          take(Landmark(*landmark));
      },
      2);
  ASSERT_EQ(section.landmarks.size(), 2u);
  EXPECT_EQ(section.landmarks[0].uid, "mt-one");
  EXPECT_EQ(section.landmarks[1].uid, "mt-two");
  EXPECT_EQ(section.count, 3);
  const std::size_t elevation = *find_feature(section.type, "elevation");
  EXPECT_THAT(section.values[elevation], ::testing::UnorderedElementsAre(1000, 2000, 3000));
  double west = 180, north = -90;
  for (const Landmark& landmark : map.landmarks) {
    west = std::min(west, landmark.position.xyz.x());
    north = std::max(north, landmark.position.xyz.y());
  }
  EXPECT_EQ(section.extent->west, west);
  EXPECT_EQ(section.extent->north, north);
}

TEST(DrawMarkers, ForemostComesLastAndLabelled) {
  const geodb::MapContents map = test::three_summits("EPSG:4326", -70, -32, 0.1);
  const LandmarkSection section = section_of(map);
  const MapView view = view_of(map.crs, {-70.2, -32.2, -69.8, -31.8});
  const MapMarkers markers = draw_markers(view, {section});
  EXPECT_EQ(markers.drawn, 3u);
  EXPECT_GT(markers.svg.find("mt-one"), markers.svg.find("mt-three"));
  EXPECT_THAT(markers.svg, HasSubstr(">3000</text>"));
}

/// Many landmarks of one type in rows of 100 over a kilometre.
geodb::MapContents crowd_of(const std::string& type, std::size_t count) {
  geodb::MapContents map = test::three_summits("EPSG:32719", 0, 0, 1);
  const TypeId id = map.types.id(type);
  Landmark one = map.landmarks[0];
  one.type = id;
  one.features.assign(map.types[id].features.size(),
                      FeatureValue{.value = 5, .variance = 1, .observations = 1});
  map.landmarks.clear();
  for (std::size_t i = 0; i < count; ++i) {
    one.uid = type + "-" + std::to_string(i);
    one.position.xyz << 10.0 * static_cast<double>(i % 100), 10.0 * static_cast<double>(i / 100), 0;
    map.landmarks.push_back(one);
  }
  return map;
}

/// "scale(1.23)" of the last marker.
double last_scale(const geodb::MapContents& map) {
  const MapView view = view_of(map.crs, {0, 0, 1000, 1000});
  const LandmarkSection section = section_of(map);
  const std::string svg = draw_markers(view, {section}).svg;
  return std::stod(svg.substr(svg.rfind(" scale(") + 7));
}

TEST(DrawMarkers, ShrinkWhereTheyAreCrowded) {
  const double alone = last_scale(crowd_of("tree", 10)), crowded = last_scale(crowd_of("tree", 2500));
  EXPECT_LT(crowded, alone / 2);
  EXPECT_LE(2500 * 4 * crowded * crowded, 0.062 * 1000 * 1000) << "their squares cover 6 % of the map";
  EXPECT_GE(crowded, 1.2) << "still to be seen";
}

TEST(DrawMarkers, BowlsStayTrueToScale) {
  EXPECT_EQ(last_scale(crowd_of("crater", 10)), last_scale(crowd_of("crater", 2500)));
}

}  // namespace
}  // namespace waymark::test
