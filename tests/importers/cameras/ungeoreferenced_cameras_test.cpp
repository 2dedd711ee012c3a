// SPDX-License-Identifier: Apache-2.0
// Camera files without a georeference on Earth: COLMAP, Metashape, ASP, CSM. Each test catches a classic
// mistake.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "importers/images/image.hpp"
#include "tests/importers/camera_data.hpp"
#include "tests/importers/raster_maker.hpp"

namespace waymark::test {
using namespace importers;
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

TEST(Colmap, ReadsBinaryModels) {
  SKIP_WITHOUT_CAMERA_DATA();
  EXPECT_THAT(message_of([] { import_cameras(camera_data("colmap"), "", {.crs = "EPSG:32651"}); }),
              HasSubstr("no position, direction or scale"));
  const CameraSet set = import_cameras(camera_data("colmap"), "", {.crs = "local", .camera_crs = "local"});
  EXPECT_EQ(set.format, "colmap");
  ASSERT_FALSE(set.images.empty());
  for (const ImageCamera& image : set.images) {
    ASSERT_TRUE(image.view);
    const Camera& c = image.view->camera;
    // COLMAP starts from the middle of the image, width / 2 from the corner: (width - 1) / 2 for us.
    EXPECT_NEAR(c.cx, static_cast<double>(c.columns - 1) / 2, 0.05 * static_cast<double>(c.columns));
  }
  RecordProperty("cx", std::to_string(set.images[0].view->camera.cx));
}

// Cameras that look at one object: the rays through the middles of the images meet in front of them, not
// behind.
TEST(Colmap, PosesAreWorldToCamera) {
  SKIP_WITHOUT_CAMERA_DATA();
  const CameraSet set = import_cameras(camera_data("colmap"), "", {.crs = "local", .camera_crs = "local"});
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const ImageCamera& image : set.images) {
    const Eigen::Vector3d d = looks_along(*image.view);
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - d * d.transpose();
    sum += across;
    right += across * image.view->centre().xyz;
  }
  const Eigen::Vector3d meeting = sum.ldlt().solve(right);
  int before = 0;
  for (const ImageCamera& image : set.images)
    before += looks_along(*image.view).dot(meeting - image.view->centre().xyz) > 0;
  RecordProperty("before", before);
  EXPECT_GT(before, static_cast<int>(0.8 * static_cast<double>(set.images.size())));
}

TEST(Colmap, RefusesImagesOfNoSize) {
  for (const char* size : {"-4 512", "512 -4", "-9223372036854775808 512", "512 0"}) {
    write_text("images.txt", "1 1 0 0 0 0 0 5 1 a.png\n\n");
    const std::string path =
        write_text("cameras.txt", fmt::format("1 SIMPLE_PINHOLE {} 500 256 256\n", size));
    EXPECT_THAT(message_of([&] { import_cameras(path, "", {.crs = "local", .camera_crs = "local"}); }),
                HasSubstr("both must be positive"));
  }
}

TEST(Metashape, CountsCamerasThatAreNotAligned) {
  SKIP_WITHOUT_CAMERA_DATA();
  const CameraSet set = import_cameras(camera_data("metashape/hwiyoung_cameras.xml"), "",
                                       {.crs = "local", .camera_crs = "local"});
  EXPECT_EQ(set.format, "metashape");
  EXPECT_EQ(set.images.size(), 120u);
  EXPECT_THAT(set.warnings, Contains(HasSubstr("120 of 120 cameras have no pose")));
}

TEST(Metashape, ReadsPosesAndAdjustedLenses) {
  SKIP_WITHOUT_CAMERA_DATA();
  const CameraSet set = import_cameras(camera_data("metashape/bitbyt3r_cameras.xml"), "",
                                       {.crs = "local", .camera_crs = "local"});
  int posed = 0;
  const ImageCamera* first = nullptr;
  for (const ImageCamera& image : set.images) {
    posed += image.view.has_value();
    if (!first && image.view) first = &image;
  }
  EXPECT_EQ(posed, 94);
  const Camera& c = first->view->camera;
  EXPECT_NEAR(c.fx, 8397.0800252741 + 0.256163863908223, 1e-9);  // f + b1
  EXPECT_NEAR(c.fy, 8397.0800252741, 1e-9);
  EXPECT_NEAR(c.skew, -22.8315524998528, 1e-9);               // b2
  EXPECT_NEAR(c.distortion[2], 0.00126022593561743, 1e-12);   // OpenCV's p1 is p2
  EXPECT_NEAR(c.distortion[3], -0.00119014441157678, 1e-12);  // and its p2 is p1
  EXPECT_NEAR(c.cx, 2591.5, 1e-9);
}

// Camera to chunk: 94 cameras on a turntable look at what stands on it.
TEST(Metashape, TransformsAreCameraToChunk) {
  SKIP_WITHOUT_CAMERA_DATA();
  const CameraSet set = import_cameras(camera_data("metashape/bitbyt3r_cameras.xml"), "",
                                       {.crs = "local", .camera_crs = "local"});
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const ImageCamera& image : set.images) {
    if (!image.view) continue;
    const Eigen::Vector3d d = looks_along(*image.view);
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - d * d.transpose();
    sum += across;
    right += across * image.view->centre().xyz;
  }
  const Eigen::Vector3d meeting = sum.ldlt().solve(right);
  int before = 0;
  for (const ImageCamera& image : set.images)
    if (image.view) before += looks_along(*image.view).dot(meeting - image.view->centre().xyz) > 0;
  EXPECT_EQ(before, 94);
}

TEST(Tsai, ReadsOldFilesWithoutHeader) {
  SKIP_WITHOUT_CAMERA_DATA();
  const CameraSet set =
      import_cameras(camera_data("asp/black_left.tsai"), "", {.crs = "local", .camera_crs = "local"});
  EXPECT_EQ(set.format, "tsai");
  const PosedCamera& view = view_of(set, "black_left.tif");
  EXPECT_NEAR(view.camera.fx, 620.857971191406, 1e-9);
  EXPECT_NEAR(view.camera.cx, 526.128784179688, 1e-9);
  EXPECT_NEAR(view.camera.distortion[3], 0.00110327918082476, 1e-15);
  EXPECT_LT((view.centre().xyz - Eigen::Vector3d(0.0751, -0.065, -0.902)).norm(), 1e-12);
  // R is camera to world: its columns are the camera's axes. The mast of a rover looks ahead and down (z
  // down).
  const Eigen::Vector3d axis = view.grid_from_camera.transform.linear().col(2);
  EXPECT_NEAR(axis.x(), 0.928, 1e-3);
  EXPECT_NEAR(axis.z(), 0.371, 1e-3);
}

TEST(CsmIsd, PutsTheRoverIntoGaleCrater) {
  SKIP_WITHOUT_CAMERA_DATA();
  const std::string path = camera_data("isd/msl_nadir_isd.json");
  const Crs degrees = Crs::from_text("IAU_2015:49900");
  const std::string local = local_projection(degrees, 137.4, -4.7);
  const CameraSet set = import_cameras(path, "", {.crs = local});
  EXPECT_EQ(set.format, "csm_isd");
  const PosedCamera& view = view_of(set, "msl_nadir_isd.img");
  const auto [lon, lat] =
      CrsTransform(set.crs, geographic_crs(set.crs))(view.centre().xyz.x(), view.centre().xyz.y());
  EXPECT_NEAR(lon, 137.4, 0.1);  // from J2000 without the rotation of Mars: anywhere
  EXPECT_NEAR(lat, -4.7, 0.1);
  // The file was made with the rover level: its z axis, in the camera the last column of the constant
  // rotation, is down.
  const Eigen::Vector3d rover_down(-0.022316998, 0.503073949, 0.863955180);
  EXPECT_LT((view.grid_from_camera.transform.linear() * rover_down).z(), -0.99);
  ASSERT_TRUE(set.images[0].sun);
  EXPECT_GT(set.images[0].sun->elevation.value, 0);
}

// A camera in orbit, placed about itself on a sphere of that radius, where up is away from the centre.
PosedCamera in_orbit(const std::string& file, double radius) {
  const std::string sphere =
      "+a=" + std::to_string(radius) + " +b=" + std::to_string(radius) + " +units=m +no_defs";
  double lon = 0, lat = 0;
  PosedCamera view;
  for (int step = 0; step < 2; ++step) {
    const CameraSet set = import_cameras(camera_data("isd/" + file), "",
                                         {.crs = "+proj=tmerc +lat_0=" + std::to_string(lat) +
                                                 " +lon_0=" + std::to_string(lon) + " " + sphere});
    view = *set.images.at(0).view;
    const auto at =
        CrsTransform(set.crs, geographic_crs(set.crs))(view.centre().xyz.x(), view.centre().xyz.y());
    lon = at.x;
    lat = at.y;
  }
  return view;
}

// Dawn's camera looked straight at the middle of Vesta: with a quaternion the other way round it looks 54 deg
// past it.
TEST(CsmIsd, LooksAtTheMiddleOfVesta) {
  SKIP_WITHOUT_CAMERA_DATA();
  const PosedCamera view = in_orbit("dawnfc_radtan.json", 265000);
  EXPECT_LT(view.grid_from_camera.transform.linear()(2, 2), -0.9999);
  EXPECT_NEAR(view.centre().xyz.z(), 2995432 - 265000, 5000);
  EXPECT_NEAR(view.camera.cx, 511.5, 1e-9);  // CSM's 512 is a corner
  EXPECT_NEAR(view.camera.fx, 150.07 * 71.40816909454442, 1e-6);
  EXPECT_NEAR(view.camera.distortion[0], 8.4e-6 * 150.07 * 150.07, 1e-9);  // given per mm^2
}

TEST(CsmIsd, RefusesLineScanners) {
  SKIP_WITHOUT_CAMERA_DATA();
  EXPECT_THAT(
      message_of([] { import_cameras(camera_data("isd/ctx_isd.json"), "", {.crs = "IAU_2015:49910"}); }),
      HasSubstr("use orthophotos"));
}

// The scans of Apollo 15's mapping camera are mirrored, which a negative focal length in x keeps.
TEST(CsmIsd, KeepsMirroredImagesMirrored) {
  SKIP_WITHOUT_CAMERA_DATA();
  const PosedCamera view = in_orbit("apollometric_isd.json", 1737400);
  EXPECT_NEAR(view.centre().xyz.z(), 118600, 1000);
  EXPECT_NEAR(view.camera.fx, -76.054 * 200, 1e-6);
  EXPECT_NEAR(view.camera.fy, 76.054 * 200, 1e-6);
  EXPECT_NEAR(view.grid_from_camera.transform.linear().determinant(), 1, 1e-12);
}

}  // namespace
}  // namespace waymark::test
