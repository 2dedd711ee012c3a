// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/photo_priors.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <tuple>

namespace waymark::test {
namespace {
using namespace workflows;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

// A picture on the central meridian of zone 32, whose gimbal looks straight down with the top to the north.
Photo picture_from_above(int orientation) {
  Photo photo{.name = "a.jpg"};
  photo.metadata.position = importers::PhotoPosition{.lon = 9, .lat = 48, .altitude = 500};
  photo.metadata.gimbal = importers::GimbalAngles{.yaw = 0, .pitch = -90, .roll = 0};
  photo.metadata.orientation = orientation;
  return photo;
}

// Directions on the ground, east and north, in which the columns and the rows of the stored picture run.
struct StoredAxes {
  Eigen::Vector2d columns, rows;
};
StoredAxes stored_axes(int orientation) {
  Photos photos;
  photos.photos.push_back(picture_from_above(orientation));
  const PhotoPriors priors = photo_priors(photos, "");
  if (priors.attitudes.size() != 1) return {{0, 0}, {0, 0}};
  const Eigen::Matrix3d turn = priors.attitudes[0].world_from_camera.toRotationMatrix();
  return {turn.col(0).head<2>(), turn.col(1).head<2>()};
}

MATCHER_P2(RunsTo, east, north, "") {
  return (arg - Eigen::Vector2d(east, north)).norm() < 1e-9;
}

// EXIF 2.32, 4.6.4 A: "6: the 0th row is the visual right-hand side, the 0th column is the visual top".
TEST(PhotoPriors, TurnedPicturesTurnTheAttitude) {
  EXPECT_THAT(stored_axes(1).columns, RunsTo(1, 0));
  EXPECT_THAT(stored_axes(1).rows, RunsTo(0, -1));
  EXPECT_THAT(stored_axes(3).columns, RunsTo(-1, 0));
  EXPECT_THAT(stored_axes(3).rows, RunsTo(0, 1));
  EXPECT_THAT(stored_axes(6).columns, RunsTo(0, -1));
  EXPECT_THAT(stored_axes(6).rows, RunsTo(-1, 0));
  EXPECT_THAT(stored_axes(8).columns, RunsTo(0, 1));
  EXPECT_THAT(stored_axes(8).rows, RunsTo(1, 0));
}

TEST(PhotoPriors, MirroredPicturesHaveNoAttitude) {
  for (const int mirrored : {2, 4, 5, 7}) EXPECT_EQ(stored_axes(mirrored).columns.norm(), 0) << mirrored;
}

// Five pictures 30 m apart. `liar` states another position.
Photos row_of_pictures(std::size_t liar, const importers::PhotoPosition& stated) {
  Photos photos;
  for (std::size_t i = 0; i < 5; ++i) {
    Photo photo{.name = std::string(1, static_cast<char>('a' + i)) + ".jpg"};
    photo.metadata.position =
        importers::PhotoPosition{.lon = 7.5 + 4e-4 * double(i), .lat = 48, .altitude = 500};
    photo.metadata.height_above_takeoff = 60;
    if (i == liar) photo.metadata.position = stated;
    photos.photos.push_back(photo);
  }
  return photos;
}

TEST(PhotoPriors, APositionInTheWrongHemisphereIsNamed) {
  const std::tuple<importers::PhotoPosition, const char*> lies[] = {
      {{.lon = -7.5, .lat = 48, .altitude = 500}, "hemisphere of longitude"},
      {{.lon = 7.5, .lat = -48, .altitude = 500}, "hemisphere of latitude"},
      {{.lon = 48, .lat = 7.5, .altitude = 500}, "are exchanged"},
      {{.lon = 7.5, .lat = 51, .altitude = 500}, "check the clock"}};
  for (const std::size_t liar : {0u, 3u})
    for (const auto& [stated, cause] : lies) {
      const PhotoPriors priors = photo_priors(row_of_pictures(liar, stated), "");
      EXPECT_EQ(priors.crs, "EPSG:32632");
      EXPECT_EQ(priors.positions.size(), 4u);
      EXPECT_THAT(priors.warnings,
                  ElementsAre(AllOf(HasSubstr(liar == 0 ? "a.jpg" : "d.jpg"), HasSubstr(cause))));
    }
}

TEST(PhotoPriors, OneWrongAltitudeDoesNotMoveTheTakeOff) {
  const PhotoPriors priors =
      photo_priors(row_of_pictures(2, {.lon = 7.5008, .lat = 48, .altitude = 5500}), "");
  ASSERT_EQ(priors.positions.size(), 5u);
  for (const auto& p : priors.positions) EXPECT_NEAR(p.position.z(), 500, 1e-9);
}

}  // namespace
}  // namespace waymark::test
