// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/georeference.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/pipeline/reconstruction/made_scene.hpp"

namespace waymark::test {
namespace {
using namespace pipeline;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const MadeSceneOptions kOptions{.seed = 8, .tilt = 0.1, .corner = {645000, 5123000, 400}};

// Made scene as tie points alone would give it: turned, shrunk, near the origin.
MadeScene free_scene(const MadeSceneOptions& options) {
  MadeScene made = made_scene(options);
  Similarity away{.scale = 0.02};
  away.rotation = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized().toRotationMatrix();
  away.shift = -away.scale * (away.rotation * (options.corner + Eigen::Vector3d(30, 20, 90)));
  adjust(made.start, {});
  transform(made.start, 0, away);
  made.start.frame = ReconstructionFrame::arbitrary;
  return made;
}

double largest_error(const Reconstruction& found, const Reconstruction& truth) {
  double largest = 0;
  for (std::size_t i = 0; i < found.images.size(); ++i)
    largest = std::max(largest, (found.images[i].world_from_camera->translation() -
                                 truth.images[i].world_from_camera->translation())
                                    .norm());
  return largest;
}

// Largest error of a camera's position against its covariance; 21 is exceeded once in 10000.
double largest_chi2(const Reconstruction& found, const Reconstruction& truth) {
  double largest = 0;
  for (std::size_t i = 0; i < found.images.size(); ++i) {
    const Eigen::Vector3d error =
        found.images[i].world_from_camera->translation() - truth.images[i].world_from_camera->translation();
    const Eigen::Matrix3d covariance = found.images[i].covariance->bottomRightCorner<3, 3>();
    largest = std::max(largest, error.dot(covariance.ldlt().solve(error)));
  }
  return largest;
}

TEST(Georeference, ControlPointsGiveTheFrame) {
  MadeScene made = free_scene(kOptions);
  Observations seen{.control = made_control(made, kOptions, 3, 2, 0.02)};
  seen.control[2].check = true;
  const Georeferenced found = georeference(made.start, seen);
  EXPECT_TRUE(found.metric) << ::testing::PrintToString(found.messages);
  EXPECT_TRUE(found.messages.empty()) << ::testing::PrintToString(found.messages);
  EXPECT_LT(largest_chi2(made.start, made.truth), 21);
  EXPECT_LT(found.adjustment.control[2].error.norm(), 0.3);
}

TEST(Georeference, PositionsOfCamerasGiveTheFrame) {
  MadeScene made = free_scene(kOptions);
  const Observations seen{.positions = made_positions(made.truth, 0.5, 3)};
  const Georeferenced found = georeference(made.start, seen);
  EXPECT_TRUE(found.metric);
  EXPECT_LT(largest_chi2(made.start, made.truth), 21);
}

TEST(Georeference, TwoPointsNeedTheVertical) {
  MadeScene made = free_scene(kOptions);
  Observations seen{.control = made_control(made, kOptions, 2, 1, 0.02)};
  Reconstruction without = made.start;
  const Georeferenced lost = georeference(without, seen);
  EXPECT_FALSE(lost.metric);
  EXPECT_EQ(without.frame, ReconstructionFrame::arbitrary);
  EXPECT_THAT(lost.messages,
              Contains(HasSubstr("2 control points and positions of cameras are known, and 3")));
  for (std::size_t i = 0; i < 4; ++i)
    seen.ups.push_back(
        {i, made.truth.images[i].world_from_camera->linear().transpose() * Eigen::Vector3d::UnitZ(), 0.001});
  const Georeferenced found = georeference(made.start, seen);
  EXPECT_TRUE(found.metric) << ::testing::PrintToString(found.messages);
  EXPECT_LT(largest_chi2(made.start, made.truth), 21);
}

TEST(Georeference, PointsOnOneLineLeaveTheTurnOpen) {
  MadeSceneOptions flat = kOptions;
  flat.relief = 0;
  MadeScene made = free_scene(flat);
  Observations seen{.control = made_control(made, flat, 3, 1, 0.02)};
  Georeferenced found = georeference(made.start, seen);
  EXPECT_FALSE(found.metric);
  EXPECT_THAT(found.messages, Contains(HasSubstr("of one line")));
  EXPECT_THAT(found.messages, Contains(HasSubstr("the direction of gravity")));
}

TEST(Georeference, ABlunderIsNamed) {
  MadeScene made = free_scene(kOptions);
  Observations seen{.control = made_control(made, kOptions, 3, 2, 0.02)};
  seen.control[1].position.x() += 100;
  const Georeferenced found = georeference(made.start, seen);
  EXPECT_TRUE(found.metric);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(found.adjustment.control[i].used, i != 1) << i;
  EXPECT_THAT(found.messages, Contains(HasSubstr("control point P01 is ")));
  EXPECT_LT(largest_chi2(made.start, made.truth), 21);
}

// What a frame bends grows with its extent, which a blunder must not enlarge.
TEST(Georeference, ABlunderOfKilometresIsNamed) {
  for (const double metres : {1e3, 2e4, 2e6}) {
    MadeScene made = free_scene(kOptions);
    Observations seen{.positions = made_positions(made.truth, 0.5, 3)};
    seen.positions[4].position.z() += metres;
    const Georeferenced found = georeference(made.start, seen);
    EXPECT_TRUE(found.metric) << metres;
    EXPECT_THAT(found.messages, ElementsAre(HasSubstr("position of image ")));
    EXPECT_LT(largest_chi2(made.start, made.truth), 21) << metres;
  }
}

TEST(Georeference, AHeightThatIsNotSurveyedHasNoError) {
  MadeScene made = free_scene(kOptions);
  Observations seen{.control = made_control(made, kOptions, 3, 3, 0.02)};
  for (const std::size_t i : {1u, 4u, 7u})
    seen.control[i].position.z() = 0, seen.control[i].sd.z() = std::numeric_limits<double>::infinity();
  seen.control[4].check = seen.control[5].check = seen.control[7].check = true;
  seen.control[7].position.x() += 50;
  const Georeferenced found = georeference(made.start, seen);
  EXPECT_TRUE(found.metric);
  const auto& control = found.adjustment.control;
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(std::isnan(control[i].error.z()), i == 1 || i == 4 || i == 7) << i;
    EXPECT_LT(control[i].error.head<2>().norm(), i == 7 ? 51 : 0.3) << i;
  }
  EXPECT_TRUE(control[1].used);
  EXPECT_LT(control[4].statistic, 4);
  EXPECT_GT(control[7].statistic, 4);  // its two other coordinates are tested
}

TEST(Georeference, ASmallBlunderIsNamedByItsTest) {
  MadeScene made = free_scene(kOptions);
  Observations seen{.control = made_control(made, kOptions, 3, 2, 0.02)};
  seen.control[4].position.y() += 0.5;
  const Georeferenced found = georeference(made.start, seen);
  EXPECT_TRUE(found.metric);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(found.adjustment.control[i].used, i != 4) << i;
  EXPECT_THAT(found.messages, Contains(HasSubstr("control point P11: left out")));
}

TEST(Georeference, SwappedNamesAreNamed) {
  MadeScene made = free_scene(kOptions);
  Observations seen{.control = made_control(made, kOptions, 3, 3, 0.02)};
  std::swap(seen.control[0].position, seen.control[5].position);
  const Georeferenced found = georeference(made.start, seen);
  EXPECT_TRUE(found.metric);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(found.adjustment.control[i].used, i != 0 && i != 5) << i;
  EXPECT_THAT(found.messages, Contains(HasSubstr("names swapped?")));
  EXPECT_LT(largest_chi2(made.start, made.truth), 21);
}

// A track of cameras leaves the roll about it open: positions alone do not give the frame.
TEST(Georeference, CamerasInOneLineNeedTheVerticalOrADem) {
  MadeSceneOptions track = kOptions;
  track.columns = 8;
  track.rows = 1;
  track.points = 400;
  MadeScene made = free_scene(track);
  const Eigen::Vector3d first = made.truth.images[0].world_from_camera->translation();
  const Observations seen{.positions =
                              made_positions(made.truth, 3, 4)};  // 3 m: as wide as the track is crooked
  Reconstruction rolled = made.start, levelled = made.start, on_ground = made.start;
  const Georeferenced lost = georeference(rolled, seen);
  EXPECT_FALSE(lost.metric);
  EXPECT_THAT(lost.messages, Contains(HasSubstr("of one line")));
  Observations more = seen;
  for (std::size_t i = 0; i < 8; ++i)
    more.ups.push_back(
        {i, made.truth.images[i].world_from_camera->linear().transpose() * Eigen::Vector3d::UnitZ(), 0.01});
  EXPECT_TRUE(georeference(levelled, more).metric);
  EXPECT_LT(largest_error(levelled, made.truth), 9);
  Observations dem = seen;
  dem.surface = ObservedSurface{
      [&](double x, double y) {
        const double e = x - track.corner.x(), n = y - track.corner.y();
        return std::optional(track.corner.z() + track.relief * (std::sin(e / 13) * std::cos(n / 17) +
                                                                0.5 * std::sin((e + 2 * n) / 7)));
      },
      2};
  const Georeferenced found = georeference(on_ground, dem);
  EXPECT_TRUE(found.metric) << ::testing::PrintToString(found.messages);
  EXPECT_LT(largest_error(on_ground, made.truth), 3);
  EXPECT_GT(first.z(), 400);
}

TEST(Georeference, NothingKnownStaysArbitrary) {
  MadeScene made = free_scene(kOptions);
  const Georeferenced found = georeference(made.start, {});
  EXPECT_FALSE(found.metric);
  EXPECT_THAT(found.messages, Contains(HasSubstr("0 control points and positions of cameras are known")));
  EXPECT_EQ(found.adjustment.free_datum, 7);
  EXPECT_TRUE(made.start.images[0].covariance);
}

}  // namespace
}  // namespace waymark::test
