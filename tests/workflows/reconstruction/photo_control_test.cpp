// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/photo_control.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/error.hpp"
#include "tests/support/message_of.hpp"

namespace waymark::test {
namespace {
using namespace workflows;
using testing::HasSubstr;

std::string list_file(const std::string& text) {
  const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
  const auto path = std::filesystem::path(testing::TempDir()) / ("photo_control_" + name + ".txt");
  std::ofstream(path) << text;
  return path.string();
}

// Two pictures of 1000 x 800 pixels at 9 degrees east, 48 north.
Photos pictures(double lon = 9, double lat = 48) {
  Photos photos;
  for (const char* name : {"a.jpg", "b.jpg"}) {
    Photo& photo = photos.photos.emplace_back();
    photo.name = name;
    photo.metadata.columns = 1000;
    photo.metadata.rows = 800;
    photo.metadata.position = importers::PhotoPosition{.lon = lon, .lat = lat};
  }
  return photos;
}

std::string refusal_of_control(const std::string& text, const std::string& crs = "") {
  return message_of([&] { photo_control({.points = list_file(text), .crs = crs}, pictures()); });
}

TEST(PhotoControl, ConvertsToTheMap) {
  const PhotoControl found = photo_control(
      {.points = list_file(
           "EPSG:4326\n9 48 300 10 20 a.jpg P\n9 48 300 30 40 b.jpg P\n9.01 48 NaN 5 6 a.jpg check1\n")},
      pictures());
  EXPECT_EQ(found.crs, "EPSG:32632");
  ASSERT_EQ(found.points.size(), 2u);
  EXPECT_NEAR(found.points[0].position.x(), 500'000, 0.01);  // on the central meridian
  EXPECT_EQ(found.points[0].position.z(), 300);
  ASSERT_EQ(found.points[0].marks.size(), 2u);
  EXPECT_EQ(found.points[0].marks[1].image, 1u);
  EXPECT_FALSE(found.points[0].check);
  EXPECT_TRUE(found.points[1].check);
  EXPECT_TRUE(std::isinf(found.points[1].sd.z()));
  EXPECT_TRUE(found.warnings.empty());
}

TEST(PhotoControl, FeetBecomeMetres) {
  const PhotoControl found =
      photo_control({.points = list_file("EPSG:2263\n1000 2000 3 10 20 a.jpg P\n")}, pictures(-84, 34));
  EXPECT_NEAR(found.points[0].position.x(), 304.8, 0.01);
}

TEST(PhotoControl, NamesWithFoldersAreFound) {
  const PhotoControl found =
      photo_control({.points = list_file("local\n1 2 3 10 20 flight/a.jpg P\n")}, pictures());
  EXPECT_EQ(found.points[0].marks.size(), 1u);
}

TEST(PhotoControl, MarksOutsideTheImageAreLeftOut) {
  const PhotoControl found =
      photo_control({.points = list_file("local\n1 2 3 10 900 a.jpg P\n1 2 3 30 40 b.jpg P\n")}, pictures());
  EXPECT_EQ(found.points[0].marks.size(), 1u);
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_THAT(found.warnings[0],
              HasSubstr("column 10, row 900 is outside the image a.jpg of 1000 x 800 pixels"));
}

TEST(PhotoControl, SaysWhatIsWrongWithTheFrame) {
  EXPECT_THAT(refusal_of_control("EPSG:4326\n48 109 300 10 20 a.jpg P\n"),
              HasSubstr("longitude comes first, then latitude"));
  EXPECT_THAT(refusal_of_control("EPSG:4326\n48 9 300 10 20 a.jpg P\n"),
              HasSubstr("coordinates of the control points are exchanged"));
  EXPECT_THAT(refusal_of_control("EPSG:32632\n5316285 500000 300 10 20 a.jpg P\n"), HasSubstr("exchanged"));
  EXPECT_THAT(refusal_of_control("EPSG:32632\n500000 5316285 300 10 20 a.jpg P\n", "EPSG:4326"),
              HasSubstr("is in degrees"));
}

TEST(PhotoControl, ALayerWithoutCrsNeedsOne) {
  const auto folder = std::filesystem::path(testing::TempDir());
  std::ofstream(folder / "points_without_crs.csv") << "name,x,y,z\nP,1,2,3\n";
  std::ofstream(folder / "marks_of_them.csv") << "point,image,column,row\nP,a.jpg,1,2\n";
  PhotoControlRequest request{.points = (folder / "points_without_crs.csv").string(),
                              .marks = (folder / "marks_of_them.csv").string()};
  try {
    photo_control(request, pictures());
    FAIL() << "a layer without CRS was accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("the control points have no CRS"));
    EXPECT_THAT(error.what(), HasSubstr("--crs"));
  }
  request.crs = "EPSG:32632";
  EXPECT_EQ(photo_control(request, pictures()).crs, "EPSG:32632");
}

TEST(PhotoControl, PositionsThatContradictAreExplained) {
  const PhotoControl control =
      photo_control({.points = list_file("EPSG:32632\n500000 5316285 300 10 20 a.jpg P\n")}, pictures());
  EXPECT_EQ(contradiction_of_positions(control, pictures(9.01, 48.01)), "");
  EXPECT_THAT(contradiction_of_positions(control, pictures(48, 9)),
              HasSubstr("latitude and longitude are exchanged"));
  EXPECT_THAT(contradiction_of_positions(control, pictures(-9, 48)),
              HasSubstr("wrong hemisphere of longitude"));
  EXPECT_THAT(contradiction_of_positions(control, pictures(9, -48)),
              HasSubstr("wrong hemisphere of latitude"));
  EXPECT_THAT(contradiction_of_positions(control, pictures(80, 48)), HasSubstr("km from the control points"));
}

}  // namespace
}  // namespace waymark::test
