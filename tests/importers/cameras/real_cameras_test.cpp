// SPDX-License-Identifier: Apache-2.0
// Conventions of camera files of other programs, on real files: each test catches a classic mistake.
#include <gmock/gmock.h>

#include <cmath>

#include "importers/images/image_set.hpp"
#include "importers/images/list_images.hpp"
#include "importers/rasters/dem.hpp"
#include "tests/importers/camera_data.hpp"
#include "tests/importers/misregistration.hpp"
#include "tests/importers/raster_maker.hpp"

namespace waymark::test {
using namespace importers;
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

const char* const kNgiCrs =
    "+proj=tmerc +lat_0=0 +lon_0=25 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs";

Terrain terrain_from(const std::string& path) {
  const auto dem = import_dem({.files = {path}});
  const GridGeometry& g = dem->geometry();
  const HeightWindow heights = dem->read({0, 0, g.columns, g.rows});
  Grid<float> cells(g.columns, g.rows);
  for (std::int64_t r = 0; r < g.rows; ++r)
    for (std::int64_t c = 0; c < g.columns; ++c) cells(c, r) = static_cast<float>(heights(c, r));
  return Terrain(std::move(cells), g.where.x0, g.where.y0, g.where.dx, -g.where.dy);
}

std::vector<Photo> photos(const ListedImages& listed, double half_pixels = 0) {
  std::vector<Photo> all;
  for (const ImageHandle& image : image_set(listed.images)) {
    all.push_back(photo(*image));
    all.back().view.camera.cx += half_pixels;
    all.back().view.camera.cy += half_pixels;
  }
  return all;
}

std::vector<Eigen::Vector2d> all_shifts(const std::vector<Photo>& photos, const Terrain& terrain,
                                        double gsd) {
  std::vector<Eigen::Vector2d> all;
  for (std::size_t i = 0; i < photos.size(); ++i)
    for (std::size_t j = i + 1; j < photos.size(); ++j)
      for (const auto& shift : shifts(photos[i], photos[j], terrain, gsd, 40)) all.push_back(shift);
  return all;
}

ListedImages odm_images() {
  return list_images({.files = {camera_data("orthority/odm/images")},
                      .cameras = camera_data("orthority/odm/opensfm/reconstruction.json"),
                      .import = {.crs = "EPSG:32651"}});
}

ListedImages ngi_images() {
  return list_images({.files = {camera_data("orthority/ngi/3324c_*.tif")},
                      .cameras = camera_data("orthority/ngi/camera_pos_ori.txt"),
                      .import = {.crs = kNgiCrs, .interior = camera_data("orthority/ngi/config.yaml")}});
}

TEST(OpenSfm, ImagesOfOneGroundAgreeWithinADecimetre) {
  SKIP_WITHOUT_CAMERA_DATA();
  const Terrain terrain = terrain_from(camera_data("orthority/odm/odm_dem/dsm.tif"));
  const ListedImages listed = odm_images();
  ASSERT_EQ(listed.images.size(), 4u);
  const auto right = all_shifts(photos(listed), terrain, 0.2);
  const auto half_off = all_shifts(photos(listed, 0.5), terrain, 0.2);
  RecordProperty("shift_m", std::to_string(median_length(right)));
  RecordProperty("shift_with_half_a_pixel_m", std::to_string(median_length(half_off)));
  EXPECT_GT(right.size(), 150u);
  EXPECT_LT(median_length(right), 0.11);
  EXPECT_GT(median_length(half_off), 1.7 * median_length(right));
}

// The two files were written by different programs from one adjustment; ENU axes instead of the grid's put
// the cameras up to 2.2 m and 0.86 deg off.
TEST(OpenSfm, OpenDroneMapsAxesAreThoseOfTheGrid) {
  SKIP_WITHOUT_CAMERA_DATA();
  const CameraSet sfm =
      import_cameras(camera_data("orthority/odm/opensfm/reconstruction.json"), "", {.crs = "EPSG:32651"});
  const CameraSet opk = import_cameras(
      camera_data("orthority/io/odm_xyz_opk.csv"), "",
      {.crs = "EPSG:32651", .interior = camera_data("orthority/odm/opensfm/reconstruction.json")});
  EXPECT_EQ(sfm.format, "opensfm");
  EXPECT_EQ(opk.format, "opk");
  ASSERT_EQ(opk.images.size(), 4u);
  for (const ImageCamera& image : opk.images) {
    const PosedCamera& a = view_of(sfm, image.image);
    EXPECT_LT((a.centre().xyz - image.view->centre().xyz).norm(), 0.01) << image.image;
    EXPECT_LT(turn_between(a, *image.view), 0.01) << image.image;
    EXPECT_LT(looks_along(a).z(), -0.8) << image.image;
  }
}

// Plain OpenSfM is east-north-up about its reference: in the grid it turns by the meridian convergence, 0.87
// deg east of the middle of zone 33 ... and west of it the other way.
TEST(OpenSfm, EastNorthUpTurnsIntoTheGridAtTheCamera) {
  SKIP_WITHOUT_CAMERA_DATA();
  const std::string path = camera_data("opensfm_berlin/reconstruction_example.json");
  const CameraSet west = import_cameras(path, "opensfm", {.crs = "EPSG:32633"});
  const CameraSet east = import_cameras(path, "opensfm", {.crs = "EPSG:32632"});
  ASSERT_EQ(west.images.size(), 3u);
  const double lon = 13.4004, lat = 52.51896;
  const auto convergence = [&](double meridian) {
    return std::atan(std::tan((lon - meridian) * kRadiansPerDegree) * std::sin(lat * kRadiansPerDegree)) /
           kRadiansPerDegree;
  };
  EXPECT_NEAR(turn_between(*west.images[0].view, *east.images[0].view), convergence(9) - convergence(15),
              1e-3);
  EXPECT_NEAR(west.images[0].view->centre().xyz.x(), 391400, 100);
  EXPECT_NEAR(west.images[0].view->centre().xyz.z(), 26, 15);
}

TEST(Opk, ImagesOfOneGroundAgreeWithinAThirdOfAPixel) {
  SKIP_WITHOUT_CAMERA_DATA();
  const Terrain terrain = terrain_from(camera_data("orthority/ngi/dem.tif"));
  const ListedImages listed = ngi_images();
  ASSERT_EQ(listed.images.size(), 4u);
  const auto right = all_shifts(photos(listed), terrain, 5);
  const auto half_off = all_shifts(photos(listed, 0.5), terrain, 5);
  RecordProperty("shift_m", std::to_string(median_length(right)));
  RecordProperty("shift_with_half_a_pixel_m", std::to_string(median_length(half_off)));
  EXPECT_GT(right.size(), 300u);
  EXPECT_LT(median_length(right), 1.7);  // pixels are 5.6 m
  EXPECT_GT(median_length(half_off), 1.7 * median_length(right));
}

TEST(Opk, ReadsTheCrsBesideIt) {
  SKIP_WITHOUT_CAMERA_DATA();
  const CameraSet set = import_cameras(camera_data("orthority/io/ngi_xyz_opk.csv"), "",
                                       {.interior = camera_data("orthority/io/ngi_int_param.yaml")});
  EXPECT_TRUE(set.crs.same_as(Crs::from_text(kNgiCrs)));
  const PosedCamera& view = view_of(set, "3324c_2015_1004_05_0182_RGB.tif");
  EXPECT_NEAR(view.camera.fx, 120 / 92.16 * 640, 1e-9);
  EXPECT_NEAR(view.camera.cy, 575.5, 1e-9);
  EXPECT_LT(looks_along(view).z(), -0.99);
  // kappa is -179 deg: the image's upper edge is to the south.
  EXPECT_GT(view.grid_from_camera.transform.linear()(1, 1), 0.99);
}

TEST(Opk, SaysThatTheLensIsMissing) {
  SKIP_WITHOUT_CAMERA_DATA();
  EXPECT_THAT(message_of([] {
                import_cameras(camera_data("orthority/io/odm_xyz_opk.csv"), "", {.crs = "EPSG:32651"});
              }),
              HasSubstr("option interior"));
}

// A drone's gimbal pitches but does not roll: an image looks from the nadir towards its own upper or lower
// edge. With the rotation transposed it would look to the same side of the world wherever its upper edge is.
TEST(OdmShots, ImagesTiltTowardsTheirTops) {
  SKIP_WITHOUT_CAMERA_DATA();
  const CameraSet set = import_cameras(camera_data("odm_fynnher/shots.geojson"), "", {});
  EXPECT_EQ(set.format, "odm_shots");
  EXPECT_EQ(set.crs.id(), "EPSG:32632");
  ASSERT_EQ(set.images.size(), 394u);
  EXPECT_NE(set.images[0].view->camera.distortion[0], 0);
  double tilted = 0, along = 0, transposed = 0;
  for (const ImageCamera& image : set.images) {
    const Eigen::Matrix3d r = image.view->grid_from_camera.transform.linear();
    EXPECT_LT(r(2, 2), 0);  // looks down
    const double tilt = r.col(2).head<2>().norm();
    if (tilt < 0.1) continue;
    tilted += 1;
    along += std::abs(r.col(2).head<2>().dot(r.col(1).head<2>().normalized())) / tilt;
    transposed += std::abs(r.row(2).head<2>().dot(r.row(1).head<2>().normalized())) / tilt;
  }
  RecordProperty("tilted", std::to_string(tilted));
  RecordProperty("along", std::to_string(along / tilted));
  RecordProperty("transposed", std::to_string(transposed / tilted));
  ASSERT_GT(tilted, 50);
  EXPECT_GT(along / tilted, 0.95);
  EXPECT_LT(transposed / tilted, 0.9);
}

// EXIF says 11:01 local time in Taiwan, 8 h ahead; counted as UTC it would be dusk there.
TEST(SunOfPhotos, NeedsTheTimeZone) {
  SKIP_WITHOUT_CAMERA_DATA();
  const ListedImages without = odm_images();
  EXPECT_FALSE(without.images[0].sun);
  EXPECT_THAT(without.warnings, Contains(HasSubstr("have no offset from UTC")));
  ImageListing listing{.files = {camera_data("orthority/odm/images")},
                       .cameras = camera_data("orthority/odm/opensfm/reconstruction.json"),
                       .import = {.crs = "EPSG:32651"},
                       .time_zone = "+08:00"};
  const ListedImages with = list_images(listing);
  ASSERT_TRUE(with.images[0].sun);
  EXPECT_EQ(with.images[0].taken_utc, "2019-04-11T03:01:21Z");
  EXPECT_NEAR(with.images[0].sun->elevation.value, 68.75, 0.3);
  EXPECT_NEAR(with.images[0].sun->azimuth.value, 139.45, 0.5);
  listing.time_zone = "Z";
  EXPECT_THAT(list_images(listing).warnings, Contains(HasSubstr("below the horizon")));
}

}  // namespace
}  // namespace waymark::test
