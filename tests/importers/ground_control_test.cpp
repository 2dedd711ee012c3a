// SPDX-License-Identifier: Apache-2.0
#include "importers/cameras/ground_control.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/error.hpp"

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

std::string message_of(const std::string& text) {
  try {
    read_gcp_list(written(text));
  } catch (const Error& e) {
    return e.what();
  }
  return {};
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
}

TEST(GroundControl, RefusesWithTheLine) {
  EXPECT_THAT(message_of("EPSG:32632\n"), HasSubstr("there are no control points"));
  EXPECT_THAT(message_of("EPSG:32632\n1 2 3 4 5\n"), HasSubstr("the line has 5 words, not 6 or more"));
  EXPECT_THAT(message_of("EPSG:32632\n1 2 3 4 five a.jpg\n"), HasSubstr("row"));
  EXPECT_THAT(message_of("EPSG:32632\n1 2 3 4 5 a.jpg P\n1 2 4 4 5 b.jpg P\n"),
              HasSubstr("'P' has another position on an earlier line"));
  EXPECT_THAT(message_of("EPSG:32632\n1 2 3 4 5 a.jpg P\n1 2 3 4 6 a.jpg P\n"),
              HasSubstr("'P' has two marks in the image 'a.jpg'"));
}

}  // namespace
}  // namespace waymark::test
