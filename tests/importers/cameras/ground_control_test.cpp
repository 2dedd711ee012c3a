// SPDX-License-Identifier: Apache-2.0
#include "importers/cameras/ground_control.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/error.hpp"
#include "tests/support/message_of.hpp"

namespace waymark::test {
namespace {
using namespace importers;
using ::testing::HasSubstr;

std::string written(const std::string& text) {
  const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  const auto path = std::filesystem::path(::testing::TempDir()) / ("gcp_" + name + ".txt");
  std::ofstream(path) << text;
  return path.string();
}

std::string refusal_of_list(const std::string& text) {
  return message_of([&] { read_gcp_list(written(text)); });
}

TEST(GroundControl, ReadsOpenDroneMapsList) {
  const GroundControl found = read_gcp_list(written(R"(WGS84 UTM 32S
# a comment
544256.7 5320919.9 5.25 3044 2622 IMG_0525.jpg
544256.7 5320919.9 5.25 100.5 200.25 IMG_0526.jpg
544157.7 5320899.2 NaN 4193 1552 IMG_0585.jpg corner
544157.7 5320899.2 NaN 12 13 IMG_0586.jpg corner extra
)"));
  EXPECT_EQ(found.crs, "EPSG:32732");
  ASSERT_EQ(found.points.size(), 2u);
  EXPECT_EQ(found.points[0].name, "point 1");
  EXPECT_EQ(found.points[0].position, Eigen::Vector3d(544256.7, 5320919.9, 5.25));
  ASSERT_EQ(found.points[0].marks.size(), 2u);
  EXPECT_EQ(found.points[0].marks[1].image, "IMG_0526.jpg");
  EXPECT_EQ(found.points[0].marks[1].pixel, Eigen::Vector2d(100.5, 200.25));
  EXPECT_EQ(found.points[1].name, "corner");
  EXPECT_TRUE(std::isnan(found.points[1].position.z()));
  EXPECT_EQ(found.points[1].marks.size(), 2u);
  EXPECT_EQ(read_gcp_list(written("+proj=utm +zone=10 +ellps=WGS84\n1 2 3 4 5 a.jpg\n")).crs,
            "+proj=utm +zone=10 +ellps=WGS84");
  EXPECT_EQ(read_gcp_list(written("wgs84 utm 7n\n1 2 3 4 5 a.jpg\n")).crs, "EPSG:32607");
}

TEST(GroundControl, RefusesWithTheLine) {
  EXPECT_THAT(refusal_of_list("EPSG:32632\n"), HasSubstr("there are no control points"));
  EXPECT_THAT(refusal_of_list("EPSG:32632\n1 2 3 4 5\n"), HasSubstr("the line has 5 words, not 6 or more"));
  EXPECT_THAT(refusal_of_list("EPSG:32632\n1 2 3 4 five a.jpg\n"), HasSubstr("row"));
  EXPECT_THAT(refusal_of_list("EPSG:32632\n1 2 3 4 5 a.jpg P\n1 2 4 4 5 b.jpg P\n"),
              HasSubstr("'P' has another position on an earlier line"));
  EXPECT_THAT(refusal_of_list("EPSG:32632\n1 2 3 4 5 a.jpg P\n1 2 3 4 6 a.jpg P\n"),
              HasSubstr("'P' has two marks in the image 'a.jpg'"));
}

std::string table(const std::string& what, const std::string& text) {
  const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  const auto path = std::filesystem::path(::testing::TempDir()) / ("control_" + name + what + ".csv");
  std::ofstream(path) << text;
  return path.string();
}

std::string layer_message(const std::string& points, const std::string& marks) {
  return message_of([&] { read_control_layer(table("points", points), table("marks", marks)); });
}

TEST(ControlLayer, ReadsPointsAndMarks) {
  const GroundControl found = read_control_layer(
      table("points", "Name,Easting,Northing,Height,x_sd,z_sd,check\nA,1,2,3,0.02,0.04,\nB,4,5,,,,yes\n"),
      table("marks", "point,image,column,row,sd\nA,a.jpg,10,20,\nB,a.jpg,30,40,2\nA,b.jpg,1,2,1\n"));
  ASSERT_EQ(found.points.size(), 2u);
  EXPECT_EQ(found.crs, "");
  EXPECT_EQ(found.points[0].position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(found.points[0].sd, Eigen::Vector3d(0.02, 0.05, 0.04));
  EXPECT_FALSE(found.points[0].check);
  ASSERT_EQ(found.points[0].marks.size(), 2u);
  EXPECT_EQ(found.points[0].marks[1].pixel, Eigen::Vector2d(1, 2));
  EXPECT_TRUE(found.points[1].check);
  EXPECT_TRUE(std::isnan(found.points[1].position.z()));
  EXPECT_EQ(found.points[1].marks[0].sd, 2);
}

// Layers of points in the plane have their heights in a column; a third coordinate comes first.
TEST(ControlLayer, HeightsStandInAColumnOrInTheGeometry) {
  const auto path = std::filesystem::path(::testing::TempDir()) / "control_flat.geojson";
  std::ofstream(path) << R"({"type": "FeatureCollection", "features": [
{"type": "Feature", "properties": {"name": "A", "height": 412.5},
 "geometry": {"type": "Point", "coordinates": [9, 48]}},
{"type": "Feature", "properties": {"name": "B", "height": 1},
 "geometry": {"type": "Point", "coordinates": [9, 48, 400]}},
{"type": "Feature", "properties": {"name": "C", "height": null},
 "geometry": {"type": "Point", "coordinates": [9, 48]}}]})";
  const GroundControl found =
      read_control_layer(path.string(), table("marks", "point,image,column,row\nA,a.jpg,1,2\n"));
  ASSERT_EQ(found.points.size(), 3u);
  EXPECT_EQ(found.points[0].position.z(), 412.5);
  EXPECT_EQ(found.points[1].position.z(), 400);
  EXPECT_TRUE(std::isnan(found.points[2].position.z()));
}

TEST(ControlLayer, RefusesWithTheRow) {
  const std::string points = "name,x,y,z\nA,1,2,3\n", marks = "point,image,column,row\n";
  EXPECT_THAT(layer_message("name,x,z\nA,1,2\n", marks), HasSubstr("the table has no column 'y'"));
  EXPECT_THAT(layer_message("name,x,y,z\nA,1,two,3\n", marks), HasSubstr("'two' is not a number"));
  EXPECT_THAT(layer_message(points + "A,1,2,3\n", marks), HasSubstr("two control points have the name 'A'"));
  EXPECT_THAT(layer_message("name,x,y,z,sd\nA,1,2,3,-1\n", marks), HasSubstr("is not above 0"));
  EXPECT_THAT(layer_message(points, "point,image,row\nA,a.jpg,1\n"), HasSubstr("no column 'column'"));
  EXPECT_THAT(layer_message(points, marks + "B,a.jpg,1,2\n"), HasSubstr("there is no control point 'B'"));
  EXPECT_THAT(layer_message(points, marks + "A,a.jpg,1,2\nA,a.jpg,3,4\n"),
              HasSubstr("two marks in the image"));
}

TEST(GroundControl, NamesThatBeginWithCheckAreCheckPoints) {
  EXPECT_TRUE(is_check_name("check_7"));
  EXPECT_TRUE(is_check_name("CheckPoint"));
  EXPECT_FALSE(is_check_name("recheck"));
  EXPECT_FALSE(is_check_name("che"));
}

}  // namespace
}  // namespace waymark::test
