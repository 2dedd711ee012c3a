// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/pose_photos.hpp"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "core/error.hpp"
#include "core/random.hpp"
#include "core/text_file.hpp"
#include "tests/support/message_of.hpp"
#include "workflows/reconstruction/photo_priors.hpp"
#include "workflows/reconstruction/pose_summary.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

namespace fs = std::filesystem;

fs::path fresh_folder(const std::string& name) {
  const fs::path folder = fs::path(testing::TempDir()) / ("pose_photos_" + name);
  fs::remove_all(folder);
  fs::create_directories(folder / "out");
  fs::create_directories(folder / "images");
  return folder;
}

void write_pgm(const fs::path& file, int columns, int rows, const std::vector<unsigned char>& grey) {
  std::ofstream out(file, std::ios::binary);
  out << "P5\n" << columns << " " << rows << "\n255\n";
  out.write(reinterpret_cast<const char*>(grey.data()), static_cast<std::streamsize>(grey.size()));
}

// Random blocks of 4 x 4 pixels: full of corners.
std::vector<unsigned char> blocks(int columns, int rows, std::uint64_t seed) {
  Random random(seed);
  std::vector<unsigned char> cells(static_cast<std::size_t>(columns / 4 * (rows / 4)));
  for (auto& c : cells) c = static_cast<unsigned char>(40 + random.uniform_index(180));
  std::vector<unsigned char> grey(static_cast<std::size_t>(columns * rows));
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      grey[static_cast<std::size_t>(r * columns + c)] = cells[static_cast<std::size_t>(
          std::min(r / 4, rows / 4 - 1) * (columns / 4) + std::min(c / 4, columns / 4 - 1))];
  return grey;
}

std::string refusal_of_photos(const fs::path& folder) {
  return message_of(
      [&] { pose_photos({.images = {(folder / "images").string()}, .folder = (folder / "out").string()}); });
}

TEST(PosePhotos, OneImageIsTooFew) {
  const fs::path folder = fresh_folder("one");
  write_pgm(folder / "images" / "a.pgm", 200, 160, blocks(200, 160, 1));
  std::ofstream(folder / "images" / "notes.txt") << "no image";
  EXPECT_THAT(refusal_of_photos(folder),
              testing::AllOf(testing::HasSubstr("1 usable image"), testing::HasSubstr("two or more")));
}

TEST(PosePhotos, ADamagedImageIsNamed) {
  const fs::path folder = fresh_folder("damaged");
  write_pgm(folder / "images" / "a.pgm", 200, 160, blocks(200, 160, 1));
  std::ofstream(folder / "images" / "b.jpg") << "not a picture";
  EXPECT_THAT(refusal_of_photos(folder), testing::HasSubstr("b.jpg"));
}

TEST(PosePhotos, CopiesHaveNoParallax) {
  const fs::path folder = fresh_folder("copies");
  for (const char* name : {"a.pgm", "b.pgm"})
    write_pgm(folder / "images" / name, 240, 200, blocks(240, 200, 1));
  EXPECT_THAT(refusal_of_photos(folder),
              testing::AllOf(testing::HasSubstr("no parallax"), testing::HasSubstr("copies")));
}

TEST(PosePhotos, ImagesOfOneColourAreNamed) {
  const fs::path folder = fresh_folder("black");
  for (const char* name : {"a.pgm", "b.pgm"})
    write_pgm(folder / "images" / name, 240, 200, std::vector<unsigned char>(240 * 200, 0));
  EXPECT_THAT(refusal_of_photos(folder),
              testing::AllOf(testing::HasSubstr("a.pgm"), testing::HasSubstr("one value")));
}

TEST(PosePhotos, StrangersDoNotMatch) {
  const fs::path folder = fresh_folder("strangers");
  write_pgm(folder / "images" / "a.pgm", 240, 200, blocks(240, 200, 1));
  write_pgm(folder / "images" / "b.pgm", 240, 200, blocks(240, 200, 2));
  EXPECT_THAT(refusal_of_photos(folder),
              testing::AllOf(testing::HasSubstr("no two of them match"), testing::HasSubstr("overlap")));
}

TEST(PhotoPriors, ANadirGimbalLooksDownWithItsUpperEdgeToTheYaw) {
  Photos photos;
  Photo& photo = photos.photos.emplace_back();
  photo.metadata.position =
      importers::PhotoPosition{.lon = 9, .lat = 48, .altitude = 500};  // on a central meridian
  photo.metadata.gimbal = importers::GimbalAngles{.yaw = 90, .pitch = -90, .roll = 0};
  const PhotoPriors priors = photo_priors(photos, "");
  EXPECT_EQ(priors.crs, "EPSG:32632");
  ASSERT_EQ(priors.attitudes.size(), 1u);
  const Eigen::Matrix3d r = priors.attitudes[0].world_from_camera.toRotationMatrix();
  EXPECT_TRUE(r.col(2).isApprox(-Eigen::Vector3d::UnitZ(), 1e-4));  // view down
  EXPECT_TRUE(r.col(1).isApprox(-Eigen::Vector3d::UnitX(), 1e-4));  // upper edge to the east
  EXPECT_NEAR(priors.positions[0].position.x(), 500'000, 1);
  EXPECT_TRUE(priors.positions[0].biased_height);
}

TEST(PhotoPriors, DegreesAreRefused) {
  Photos photos;
  photos.photos.emplace_back().metadata.position = importers::PhotoPosition{.lon = 9, .lat = 48};
  EXPECT_THROW(photo_priors(photos, "EPSG:4326"), Error);
}

// Fountain-P11 (Strecha et al. 2008) with its known calibration, centres to 3 mm.
TEST(PosePhotos, TheFountainIsPosedToMillimetres) {
  const fs::path data = fs::path(WAYMARK_SOURCE_DIR) / "../shared/data/reconstruction/fountain_p11";
  if (!fs::exists(data)) GTEST_SKIP() << "needs " << data;
  const fs::path folder = fresh_folder("fountain");
  std::ofstream(folder / "lens.json")
      << R"({"waymark_cameras": 1, "frame": {"axes": "arbitrary"}, "cameras": {"l": {"columns": 1536, "rows": 1024, "fx": 1379.74,
          "fy": 1382.08, "cx": 760.095, "cy": 503.155, "lens": "brown", "distortion": []}}, "images": [{"name": "0000.jpg", "camera": "l"}]})";
  const PosedPhotos posed = pose_photos({.images = {(data / "images").string()},
                                         .folder = (folder / "out").string(),
                                         .lens = (folder / "lens.json").string()});
  ASSERT_EQ(posed.posed, 11u);
  Eigen::Matrix3Xd estimated(3, 11), truth(3, 11);
  std::istringstream table(read_text(data / "truth_poses.csv", "poses"));
  std::string line;
  std::getline(table, line);
  for (Eigen::Index i = 0; i < 11 && std::getline(table, line); ++i) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream row(line);
    std::string name;
    row >> name >> truth(0, i) >> truth(1, i) >> truth(2, i);
    ASSERT_EQ(posed.scene.images[static_cast<std::size_t>(i)].name, name);
    estimated.col(i) = posed.scene.images[static_cast<std::size_t>(i)].world_from_camera->translation();
  }
  const Eigen::Matrix4d fit = Eigen::umeyama(estimated, truth, true);
  const Eigen::Matrix3Xd off = (fit * estimated.colwise().homogeneous()).topRows<3>() - truth;
  EXPECT_LT(off.colwise().norm().mean(), 0.004);  // 2.9 mm measured
}

// Cells of a comma-separated file, without its header.
std::vector<std::vector<std::string>> rows_of(const fs::path& file) {
  std::istringstream text(read_text(file, "table"));
  std::vector<std::vector<std::string>> rows;
  std::string line, word;
  for (std::getline(text, line); std::getline(text, line);) {
    std::istringstream words(line);
    rows.emplace_back();
    while (std::getline(words, word, ',')) rows.back().push_back(word);
  }
  return rows;
}

// Five images of 115 megapixels with 14 control and 2 check points (Damped Bundle Adjustment Toolbox). A
// pixel is 8.6 cm on the ground. The published adjustment of marks by hand is off by 0.3 m in plan and 0.34 m
// in height.
TEST(PosePhotos, StrasbourgIsTiedToItsControlPoints) {
  const fs::path data = fs::path(WAYMARK_SOURCE_DIR) / "../shared/data/reconstruction/aerial_strasbourg";
  if (!fs::exists(data)) GTEST_SKIP() << "needs " << data;
  const fs::path folder = fresh_folder("strasbourg");
  std::ofstream(folder / "lens.json")
      << R"({"waymark_cameras": 1, "frame": {"axes": "arbitrary"}, "cameras": {"l": {"columns": 8858, "rows": 12996, "fx": 20656.53,
          "fy": 20656.53, "cx": 4429, "cy": 6468, "lens": "brown", "distortion": []}}, "images": [{"name": "8811.jpg", "camera": "l"}]})";
  std::ofstream points(folder / "points.csv"), marks(folder / "marks.csv");
  points << "name,x,y,z,x_sd,y_sd,z_sd,check\n";
  for (const auto& row : rows_of(data / "truth/control_points.csv"))
    points << row[0] << "," << row[2] << "," << row[3] << "," << row[4] << "," << row[5] << "," << row[6]
           << "," << row[7] << "," << (row[0] == "351" || row[0] == "410") << "\n";
  marks << "point,image,column,row\n";  // pixels count from their centres here, from the corner there
  marks.precision(10);
  for (const auto& row : rows_of(data / "truth/control_marks.csv"))
    marks << row[0] << "," << row[1] << "," << std::stod(row[2]) - 0.5 << "," << std::stod(row[3]) - 0.5
          << "\n";
  points.close(), marks.close();
  const PosedPhotos posed = pose_photos({.images = {(data / "images").string()},
                                         .folder = (folder / "out").string(),
                                         .lens = (folder / "lens.json").string(),
                                         .control = (folder / "points.csv").string(),
                                         .marks = (folder / "marks.csv").string(),
                                         .crs = "local"});
  ASSERT_EQ(posed.posed, 5u);
  const ControlFigures control = control_figures(posed.control, false),
                       check = control_figures(posed.control, true);
  EXPECT_EQ(control.used, 14u);
  EXPECT_LT(control.plan(), 0.05);
  EXPECT_LT(control.rms.z(), 0.05);
  EXPECT_EQ(check.used, 2u);
  for (const pipeline::ControlResult& point : posed.control)
    EXPECT_LT(point.statistic, 4) << point.name;  // errors are within what is claimed
  std::printf("check points: %.3f m in plan, %.3f m in height\n", check.plan(), check.rms.z());
}

}  // namespace
}  // namespace waymark::test
