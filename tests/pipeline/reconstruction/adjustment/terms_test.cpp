// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/terms.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geo/camera.hpp"

namespace waymark::test {
namespace {
using namespace pipeline;

// Derivatives by differences along the changes of each block.
void expect_derivatives(const Term& term, std::vector<Block> blocks, const char* what) {
  const auto values = [&] {
    std::array<const double*, Term::kMaxBlocks> at{};
    for (std::size_t i = 0; i < blocks.size(); ++i) at[i] = blocks[i].value.data();
    return at;
  };
  Term::Linear linear;
  ASSERT_TRUE(term.linearize(values().data(), linear)) << what;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (Eigen::Index k = 0; k < blocks[b].changes(); ++k) {
      const double step =
          1e-6 * (blocks[b].kind == Block::Kind::lens ? 1 + blocks[b].value.cwiseAbs()[k] : 1);
      std::array<Eigen::VectorXd, 2> side;
      const Eigen::VectorXd kept = blocks[b].value;
      for (int s = 0; s < 2; ++s) {
        Eigen::VectorXd change = Eigen::VectorXd::Zero(blocks[b].changes());
        change[k] = s == 0 ? step : -step;
        apply_change(blocks[b].kind, kept.data(), change.data(), kept.size(), blocks[b].value.data());
        Term::Linear there;
        ASSERT_TRUE(term.linearize(values().data(), there));
        side[static_cast<std::size_t>(s)] = there.residual;
        blocks[b].value = kept;
      }
      const Eigen::VectorXd slope = (side[0] - side[1]) / (2 * step);
      const Eigen::VectorXd stated = linear.by_block[b].col(k);
      EXPECT_LT((slope - stated).norm(), 1e-6 * (1 + stated.norm())) << what << ", block " << b << ", " << k;
    }
}

Block pose_block() {
  Block block{Block::Kind::pose, Eigen::VectorXd(7)};
  block.value.head<4>() = Eigen::Quaterniond(0.1, 0.9, -0.2, 0.15).normalized().coeffs();
  block.value.tail<3>() << 3, 4, 50;
  return block;
}

TEST(Terms, DerivativesAreThoseOfTheResiduals) {
  for (const auto lens : {Camera::Lens::brown, Camera::Lens::fisheye}) {
    Camera camera{.columns = 1000, .rows = 800, .fx = 900, .fy = 910, .cx = 510, .cy = 390, .skew = 0.5};
    camera.lens = lens;
    camera.distortion = {-0.1, 0.05, 0.001, -0.002, 0.01, 0.02};
    if (lens == Camera::Lens::fisheye) camera.distortion = {0.12, 0.03, -0.01, 0.002};
    const auto model = lens_model(camera);
    const Block pose = pose_block();
    const Eigen::Vector3d in_camera(8, -5, 40);
    const Eigen::Vector3d world = pose_of(pose.value.data()) * in_camera;
    const auto pixel = project(camera, {in_camera});
    ASSERT_TRUE(pixel);
    const auto term = mark_term({}, {0, 1, 2}, *model, {0, *pixel + Eigen::Vector2d(0.3, -0.2), 0.5});
    const std::vector<Block> blocks{
        {Block::Kind::lens, model->parameters(camera)}, pose, {Block::Kind::point, world}};
    Term::Linear linear;
    const std::array<const double*, 3> values{blocks[0].value.data(), blocks[1].value.data(),
                                              blocks[2].value.data()};
    ASSERT_TRUE(term->linearize(values.data(), linear));
    EXPECT_NEAR(linear.residual[0], -0.6, 1e-9);  // the projection is that of geo/camera
    EXPECT_NEAR(linear.residual[1], 0.4, 1e-9);
    expect_derivatives(*term, blocks, lens == Camera::Lens::brown ? "brown" : "fisheye");
    EXPECT_EQ(model->with_parameters(camera, model->parameters(camera)).distortion, camera.distortion);
  }
  const Block pose = pose_block(), bias{Block::Kind::bias, Eigen::VectorXd::Constant(1, 2)};
  const Block point{Block::Kind::point, Eigen::Vector3d(7, 8, 9)};
  expect_derivatives(*position_term({}, {0, 1}, true, {1, 2, 3}, {0.5, 0.1, 2}), {pose, bias}, "position");
  expect_derivatives(*position_term({}, {0}, false, {1, 2, 3}, {0.5, 0.1, 2}), {point}, "control");
  const Eigen::Quaterniond near =
      Eigen::Quaterniond(pose.value.head<4>()) * Eigen::Quaterniond(1, 0.1, -0.2, 0.05);
  expect_derivatives(*attitude_term({}, 0, {0, near.normalized(), {0.1, 0.2, 0.3}}), {pose}, "attitude");
  const Eigen::Vector3d up = pose_of(pose.value.data()).linear().transpose() * Eigen::Vector3d::UnitZ();
  expect_derivatives(*up_term({}, 0, {0, up + Eigen::Vector3d(0.1, -0.2, 0.1), 0.1}), {pose}, "up");
  const ObservedSurface surface{
      [](double x, double y) { return std::optional(0.3 * x - 0.2 * y + 0.01 * x * x); }, 2};
  expect_derivatives(*surface_term({}, 0, surface, {100, 200, 0}), {point}, "surface");
}

TEST(Terms, DerivativesOfMovingCamerasAreThoseOfTheResiduals) {
  const Camera camera{.columns = 1000, .rows = 800, .fx = 900, .fy = 910, .cx = 510, .cy = 390};
  const auto model = lens_model(camera);
  const Block pose = pose_block();
  Block motion{Block::Kind::motion, Eigen::VectorXd(6)};
  motion.value << 1.5, -0.7, 0.4, 0.2, -0.3, 0.1;
  const Block point{Block::Kind::point, pose_of(pose.value.data()) * Eigen::Vector3d(8, -5, 40)};
  const Block lens{Block::Kind::lens, model->parameters(camera)};
  for (const double fraction : {-0.5, 0.0, 0.3})
    expect_derivatives(*moving_mark_term({}, {0, 1, 2, 3}, *model, {0, {600, 300}, 0.5}, fraction),
                       {lens, pose, motion, point}, "moving mark");
  motion.value.tail<3>().setZero();
  expect_derivatives(*moving_mark_term({}, {0, 1, 2, 3}, *model, {0, {600, 300}, 0.5}, 0.3),
                     {lens, pose, motion, point}, "moving mark without a turn");
  Block next = pose;
  next.value.tail<3>() << 9, 3, 51;
  expect_derivatives(*shift_term({}, {0, 1, 2}, {-0.1, 0.1}, 0.3), {motion, pose, next}, "shift");
  expect_derivatives(*turn_term({}, 0, {0.1, 0.2, 0.3}, 0.01), {motion}, "turn");
}

TEST(Terms, AHeightAboveGroundIsThatAboveThePoint) {
  const Block pose = pose_block();  // at a height of 50
  const Block point{Block::Kind::point, Eigen::Vector3d(4, 4, 7)};
  const auto term = height_above_ground_term({}, 0, 1, 2, 40, 0.5);  // the ground at the nadir is at 9
  Term::Linear linear;
  const std::array<const double*, 2> values{pose.value.data(), point.value.data()};
  ASSERT_TRUE(term->linearize(values.data(), linear));
  EXPECT_NEAR(linear.residual[0], (50 - 9 - 40) / 0.5, 1e-12);
  expect_derivatives(*term, {pose, point}, "height above ground");
}

TEST(Terms, FixedAndFreeCoordinatesGiveNoRows) {
  const double free = std::numeric_limits<double>::infinity();
  EXPECT_EQ(position_term({}, {0}, true, {}, {0, free, 0}), nullptr);
  EXPECT_EQ(position_term({}, {0}, true, {}, {0, free, 0.1})->rows, 1);
}

}  // namespace
}  // namespace waymark::test
