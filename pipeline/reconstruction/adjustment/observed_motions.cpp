// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/observed_motions.hpp"

#include "pipeline/reconstruction/adjustment/shutter_motion.hpp"

namespace waymark::pipeline {
namespace {

// Distance between the outer neighbours that a motion is expected from.
double distance_of(const Reconstruction& scene, const ExpectedMotion& expected) {
  const auto centre = [&](const auto& neighbour) {
    return Eigen::Vector3d(scene.images[neighbour.first].world_from_camera->translation());
  };
  return (centre(expected.centres.back()) - centre(expected.centres.front())).norm();
}

void add_expected_motion(const Reconstruction& scene, std::size_t image, const ExpectedMotion& expected,
                         const LeftOut& left_out, BuiltNetwork& built) {
  constexpr double kDoubt = 10;  // a sudden turn: the images say more of it than the neighbours
  const std::size_t block = *built.motion_blocks[image];
  const bool doubted = image < left_out.motions.size() && left_out.motions[image];
  const double factor_of_sd = doubted ? kDoubt : 1;
  BlockIndices of{block};
  std::vector<double> factors;
  for (const auto& [neighbour, factor] : expected.centres) {
    of.push_back(*built.pose_blocks[neighbour]);
    factors.push_back(factor);
  }
  const double apart = distance_of(scene, expected);
  const Observed what{Term::Kind::motion, image};
  if (expected.shift_sd > 0 && apart > 0)
    built.network.terms.push_back(shift_term(
        what, of, factors, factor_of_sd * left_out.motion_scales.shift * expected.shift_sd / apart));
  if (expected.turn_sd > 0)
    built.network.terms.push_back(turn_term(what, block, expected.motion.turn,
                                            factor_of_sd * left_out.motion_scales.turn * expected.turn_sd));
}

}  // namespace

void add_motions(const Reconstruction& scene, const ImageOrder& order, const LeftOut& left_out, bool estimate,
                 BuiltNetwork& built) {
  std::vector<std::optional<ExpectedMotion>> expected(scene.images.size());
  if (estimate) expected = expected_motions(scene);
  for (const std::size_t i : order.images()) {
    const AdjustedImage& image = scene.images[i];
    if (!image.world_from_camera || !image.motion) continue;
    Eigen::VectorXd value(6);
    value << image.motion->shift, image.motion->turn;
    std::vector<int> free;
    if (expected[i] && expected[i]->shift_sd > 0 && distance_of(scene, *expected[i]) > 0) free = {0, 1, 2};
    if (expected[i] && expected[i]->turn_sd > 0) free.insert(free.end(), {3, 4, 5});
    built.motion_blocks[i] = built.network.add_block(Block::Kind::motion, value, free);
  }
  for (const std::size_t i : order.images())
    if (built.motion_blocks[i] && expected[i]) add_expected_motion(scene, i, *expected[i], left_out, built);
}

}  // namespace waymark::pipeline
