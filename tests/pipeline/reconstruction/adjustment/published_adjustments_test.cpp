// SPDX-License-Identifier: Apache-2.0
#include "tests/pipeline/reconstruction/published_adjustments.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "pipeline/reconstruction/adjustment/adjust.hpp"
#include "pipeline/reconstruction/adjustment/triangulate.hpp"
#include "tests/pipeline/reconstruction/photogrammetric_lens.hpp"

namespace waymark::test {
namespace {
using namespace pipeline;

constexpr double kDegrees = 180 / 3.14159265358979323846;

AdjustmentOptions plain() {
  AdjustmentOptions options;
  options.robust = false;  // the published adjustments remove nothing
  return options;
}

void expect_published(double found, const Printed& published, const std::string& what) {
  EXPECT_NEAR(found, published.value, 0.01 * published.value + published.rounding) << what;
}

// Standard deviations of omega, phi, kappa (degrees), X, Y, Z against those of a report.
int compare_poses(const Reconstruction& scene, std::map<int, std::map<std::string, Printed>> report) {
  int compared = 0;
  const char* names[] = {"Omega", "Phi", "Kappa", "Xc", "Yc", "Zc"};
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const AdjustedImage& image = scene.images[i];
    if (!image.covariance) {
      ADD_FAILURE() << image.name << " has no covariance";
      continue;
    }
    Eigen::Matrix<double, 6, 6> by = Eigen::Matrix<double, 6, 6>::Identity();
    by.topLeftCorner<3, 3>() = opk_by_turn(image.world_from_camera->linear()) * kDegrees;
    const Eigen::Matrix<double, 6, 6> covariance = by * *image.covariance * by.transpose();
    for (int k = 0; k < 6; ++k) {
      const auto& of_photo = report[static_cast<int>(i) + 1];
      const auto sd = of_photo.find(std::string(names[k]) + " sd");
      if (sd == of_photo.end()) continue;
      expect_published(std::sqrt(covariance(k, k)), sd->second, image.name + " " + names[k]);
      ++compared;
    }
  }
  return compared;
}

// Tie points of a table: image, point, x, y. Images are numbered by `index_of`.
std::map<int, TiePoint> tie_points(const std::vector<std::vector<double>>& rows, double sd) {
  std::map<int, TiePoint> points;
  for (const auto& row : rows)
    points[static_cast<int>(row[1])].marks.push_back(
        {static_cast<std::size_t>(row[0]) - 1, {row[2], row[3]}, sd});
  return points;
}

Eigen::Isometry3d pose_from(const Eigen::Vector3d& centre, const Eigen::Vector3d& opk) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation_of(opk);
  pose.translation() = centre;
  return pose;
}

// Places the tie points by their marks, corrected for the start values of the lens.
void place(Reconstruction& scene, const PhotogrammetricLens& lens) {
  const Eigen::VectorXd parameters = lens.parameters({});
  for (TiePoint& point : scene.points) {
    auto marks = point.marks;
    for (Mark& mark : marks) mark.pixel = lens.corrected(parameters, mark.pixel);
    if (const auto found = triangulate(scene, marks)) point.position = found->position;
  }
}

TEST(PublishedAdjustments, CalibrationWithFixedControl) {
  const auto folder = reconstruction_data() / "adjustments_dbat/camcaldemo";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not on this machine";
  constexpr double kPixel = 5.43764 / 1704;
  Eigen::VectorXd start = Eigen::VectorXd::Zero(9);
  start.head<3>() << 7.5, 2272 * kPixel / 2, 1704 * kPixel / 2;
  const auto lens = std::make_shared<PhotogrammetricLens>(start, kPixel);
  Reconstruction scene;
  scene.lenses.push_back({lens->with_parameters({.columns = 2272, .rows = 1704}, start)});
  for (const auto& row : number_rows(folder / "result/camera_stations.txt")) {
    const auto rough = [](double v) { return std::round(v * 50) / 50; };  // by up to 1 cm and 0.6 degrees
    scene.images.push_back({.name = std::to_string(100 + scene.images.size()),
                            .world_from_camera = pose_from({rough(row[2]), rough(row[3]), rough(row[4])},
                                                           {rough(row[5]), rough(row[6]), rough(row[7])})});
  }
  auto points = tie_points(number_rows(folder / "measurements/markpts.txt"), 0.1);
  Observations seen;
  for (const auto& row : number_rows(folder / "reference/camcal-fixed.txt")) {
    const int id = static_cast<int>(row[0]);
    seen.control.push_back({.name = std::to_string(id),
                            .position = {row[2], row[3], row[4]},
                            .sd = Eigen::Vector3d::Zero(),
                            .marks = points[id].marks});
    points.erase(id);
  }
  for (const auto& [id, point] : points) scene.points.push_back(point);
  place(scene, *lens);
  AdjustmentOptions options = plain();
  options.lens_models = {lens};
  options.free_lens_parameters = {lens->names()};
  const AdjustmentResult found = adjust(scene, seen, options);
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.sigma0 * 0.1, 0.16148, 1e-5);
  EXPECT_EQ(found.redundancy(), 3725);
  const double published[][2] = {{7.45699532, 0.00105},    {3.61546240, 0.00082},    {2.61329280, 0.00098},
                                 {0.000389598, 2.08e-5},   {0.00458860663, 2.21e-5}, {-4.513510e-5, 2.65e-6},
                                 {-2.0525337e-6, 1.01e-7}, {-6.12803e-5, 3.52e-6},   {-4.411706e-5, 3.94e-6}};
  ASSERT_EQ(found.lenses[0].size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    const LensParameter& p = found.lenses[0][i];
    EXPECT_NEAR(p.value, published[i][0], 0.02 * published[i][1]) << p.name;
    EXPECT_NEAR(p.sd, published[i][1], 0.01 * published[i][1]) << p.name;
  }
  EXPECT_EQ(compare_poses(scene, read_report(folder / "result/report.txt")), 21 * 6);
}

TEST(PublishedAdjustments, CalibrationInTheFrameOfTheFirstPair) {
  const auto folder = reconstruction_data() / "adjustments_dbat/romabundledemo";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not on this machine";
  constexpr double kPixel = 24.0 / 3744;
  Eigen::VectorXd start = Eigen::VectorXd::Zero(9);
  start << 24.3581, 18.1143, 12, 0, 2.174e-4, -1.518e-7, 0, 0, 0;
  const auto lens = std::make_shared<PhotogrammetricLens>(start, kPixel);
  Reconstruction scene;
  scene.lenses.push_back({lens->with_parameters({.columns = 5616, .rows = 3744}, start)});
  for (const auto& row : number_rows(folder / "prior/initial_eo.txt"))
    scene.images.push_back(
        {.name = std::to_string(100 + scene.images.size()),
         .world_from_camera =
             pose_from({row[1], row[2], row[3]}, Eigen::Vector3d(row[4], row[5], row[6]) / kDegrees)});
  for (const auto& [id, point] : tie_points(number_rows(folder / "measurements/markpts.txt"), 1))
    scene.points.push_back(point);
  place(scene, *lens);
  // The largest component of a base to the first camera is held.
  const Eigen::Vector3d first = scene.images[0].world_from_camera->translation();
  std::size_t far = 0;
  Eigen::Index axis = 0;
  double largest = 0;
  for (std::size_t i = 1; i < scene.images.size(); ++i) {
    const Eigen::Vector3d base = scene.images[i].world_from_camera->translation() - first;
    if (base.cwiseAbs().maxCoeff() <= largest) continue;
    largest = base.cwiseAbs().maxCoeff(&axis);
    far = i;
  }
  Eigen::Vector3d sd = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  sd[axis] = 0;
  Observations seen;
  seen.positions.push_back({far, scene.images[far].world_from_camera->translation(), sd});
  AdjustmentOptions options = plain();
  options.lens_models = {lens};
  options.free_lens_parameters = {{"f", "px", "py", "k1", "k2"}};
  options.fixed_images = {0};
  const AdjustmentResult found = adjust(scene, seen, options);
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.sigma0, 0.582769, 1e-5);
  EXPECT_EQ(found.redundancy(), 101801);
  EXPECT_EQ(found.free_datum, 0);
  const double published[][2] = {{24.5425003, 0.00254},
                                 {18.0816295, 0.00195},
                                 {12.0164476, 0.00189},
                                 {2.21523348e-4, 2.54e-7},
                                 {-1.86984853e-7, 5.85e-10}};
  ASSERT_EQ(found.lenses[0].size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    const LensParameter& p = found.lenses[0][i];
    EXPECT_NEAR(p.value, published[i][0], 0.02 * published[i][1]) << p.name;
    EXPECT_NEAR(p.sd, published[i][1], 0.01 * published[i][1]) << p.name;
  }
  EXPECT_EQ(compare_poses(scene, read_report(folder / "result/report.txt")), 60 * 6 - 7);
}

struct Strasbourg {
  Reconstruction scene;
  Observations seen;
  std::map<int, std::size_t> check;  ///< tie points by number of the check point
};

// As published: the marks of the check points tie the images together, but their coordinates are not used.
Strasbourg strasbourg(const std::filesystem::path& folder) {
  Strasbourg out;
  out.scene.frame = ReconstructionFrame::metric;
  constexpr double kPixel = 0.006;
  Camera camera{.columns = 8858, .rows = 12996};
  camera.fx = camera.fy = 123.9392 / kPixel;
  camera.cx = 26.577 / kPixel;
  camera.cy = 38.811 / kPixel;
  out.scene.lenses.push_back({camera});
  std::map<int, std::size_t> image_of;
  for (const auto& row : number_rows(folder / "truth/adjusted_poses.csv")) {
    image_of[static_cast<int>(row[0])] = out.scene.images.size();
    const Eigen::Vector3d centre(std::round(row[1] / 10) * 10, std::round(row[2] / 10) * 10, row[3]);
    out.scene.images.push_back({.name = std::to_string(static_cast<int>(row[0])) + ".jpg",
                                .world_from_camera = pose_from(
                                    centre, Eigen::Vector3d(row[4], row[5], std::round(row[6])) / kDegrees)});
  }
  const auto marks_of = [&](const char* name, double sd) {
    auto rows = number_rows(folder / "truth" / name);
    for (auto& row : rows) {
      std::swap(row[0], row[1]);
      row[0] = static_cast<double>(image_of.at(static_cast<int>(row[0])) + 1);
    }
    return tie_points(rows, sd);
  };
  auto control = marks_of("control_marks.csv", 0.5);
  for (const auto& row : number_rows(folder / "truth/control_points.csv")) {
    const int id = static_cast<int>(row[0]);
    if (id == 351 || id == 410) {
      out.check[id] = out.scene.points.size();
      out.scene.points.push_back(control[id]);
      continue;
    }
    out.seen.control.push_back({.name = std::to_string(id),
                                .position = {row[2], row[3], row[4]},
                                .sd = {row[5], row[6], row[7]},
                                .marks = control[id].marks});
  }
  for (const auto& [id, point] : marks_of("tie_marks.csv", 1)) out.scene.points.push_back(point);
  for (TiePoint& point : out.scene.points)
    if (const auto at = triangulate(out.scene, point.marks)) point.position = at->position;
  return out;
}

TEST(PublishedAdjustments, AerialBlockWithControl) {
  const auto folder = reconstruction_data() / "aerial_strasbourg";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not on this machine";
  auto [scene, seen, check] = strasbourg(folder);
  const AdjustmentResult found = adjust(scene, seen, plain());
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.sigma0 * 0.5, 0.589299, 1e-5);
  EXPECT_EQ(found.redundancy(), 1261);
  const auto poses = number_rows(folder / "truth/adjusted_poses.csv");
  for (std::size_t i = 0; i < scene.images.size(); ++i)
    EXPECT_LT((scene.images[i].world_from_camera->translation() -
               Eigen::Vector3d(poses[i][1], poses[i][2], poses[i][3]))
                  .norm(),
              0.002)
        << scene.images[i].name;  // the published iterations end at 1e-6 of the residuals
  EXPECT_EQ(compare_poses(scene, read_report(folder / "truth/dbat_report.txt")), 30);
  const std::map<int, std::array<double, 6>> published{
      {351, {1000551.437, 112275.288, 139.401, 0.0551, 0.0347, 0.240}},
      {410, {999974.528, 112476.597, 139.856, 0.0345, 0.0356, 0.180}}};
  for (const auto& [id, p] : published) {
    const TiePoint& point = scene.points[check.at(id)];
    EXPECT_LT((*point.position - Eigen::Vector3d(p[0], p[1], p[2])).norm(), 0.002) << id;
    for (int axis = 0; axis < 3; ++axis) {
      const double sd = p[static_cast<std::size_t>(axis) + 3];
      EXPECT_NEAR(std::sqrt((*point.covariance)(axis, axis)), sd, 0.01 * sd + (axis == 2 ? 0.0005 : 5e-5))
          << id;
    }
  }
  double squares = 0;
  for (const ControlResult& c : found.control) squares += c.error.squaredNorm();
  EXPECT_NEAR(std::sqrt(squares / 14), 0.035, 0.0005);  // published: 0.035
  const auto b13 = std::ranges::find(found.control, "492", &ControlResult::name);
  EXPECT_LT((b13->error - Eigen::Vector3d(-0.046, 0.039, 0.040)).norm(), 0.002);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(std::sqrt((*b13->covariance)(axis, axis)), (Eigen::Vector3d(0.0204, 0.0196, 0.0451)[axis]),
                5e-4);
}

}  // namespace
}  // namespace waymark::test
