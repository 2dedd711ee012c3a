// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/observed_cameras.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "pipeline/reconstruction/adjustment/height_above_ground.hpp"
#include "pipeline/reconstruction/adjustment/terms.hpp"

namespace waymark::pipeline {
namespace {

using Kind = Term::Kind;

// Median of observed minus current heights.
double median_bias(const Reconstruction& scene, const Observations& seen) {
  std::vector<double> all;
  const auto add = [&](std::size_t image, double height, double sd) {
    const auto& pose = scene.images[image].world_from_camera;
    if (pose && std::isfinite(sd)) all.push_back(height - pose->translation().z());
  };
  for (const auto& o : seen.positions)
    if (o.biased_height) add(o.image, o.position.z(), o.sd.z());
  for (const auto& o : seen.heights)
    if (o.biased) add(o.image, o.height, o.sd);
  if (all.empty()) return 0;
  std::ranges::sort(all);
  return all[all.size() / 2];
}

// Adds the observations of one network.
class Adder {
 public:
  Adder(const Reconstruction& scene, const Observations& seen, const LeftOut& left_out, BuiltNetwork& built)
      : scene_(scene), seen_(seen), out_(left_out), built_(built) {}

  void position(std::size_t i) {
    const ObservedPosition& seen = seen_.positions[i];
    const auto pose = built_.pose_blocks[seen.image];
    if (!pose || at(out_.positions, i)) return;
    const Eigen::Vector3d value = seen.position - network().origin;
    BlockIndices of{*pose};
    if (seen.biased_height && built_.bias_block) of.push_back(*built_.bias_block);
    for (int axis = 0; axis < 3; ++axis)
      if (seen.sd[axis] <= 0 && (axis < 2 || of.size() < 2)) hold(*pose, axis, value[axis]);
    if (auto term = position_term({Kind::position, i}, of, true, value, seen.sd))
      network().terms.push_back(std::move(term));
  }

  void attitude(std::size_t i) {
    const ObservedAttitude& seen = seen_.attitudes[i];
    if (const auto pose = built_.pose_blocks[seen.image]; pose && !at(out_.attitudes, i))
      network().terms.push_back(attitude_term({Kind::attitude, i}, *pose, seen));
  }

  void up(std::size_t i) {
    const ObservedUp& seen = seen_.ups[i];
    if (const auto pose = built_.pose_blocks[seen.image]; pose && !at(out_.ups, i))
      network().terms.push_back(up_term({Kind::up, i}, *pose, seen));
  }

  void height(std::size_t i) {
    const ObservedHeight& seen = seen_.heights[i];
    const auto pose = built_.pose_blocks[seen.image];
    if (!pose || at(out_.heights, i)) return;
    constexpr double kFree = std::numeric_limits<double>::infinity();
    BlockIndices of{*pose};
    if (seen.biased && built_.bias_block) of.push_back(*built_.bias_block);
    const double value = seen.height - network().origin.z();
    if (seen.sd <= 0 && of.size() < 2) hold(*pose, 2, value);
    if (auto term = position_term({Kind::height, i}, of, true, {0, 0, value}, {kFree, kFree, seen.sd}))
      network().terms.push_back(std::move(term));
  }

  // The points around the nadir predict how far the ground there is above or below the nearest one.
  void height_above_ground(std::size_t i) {
    const ObservedHeightAboveGround& seen = seen_.heights_above_ground[i];
    const auto pose = built_.pose_blocks[seen.image];
    if (!pose || at(out_.heights_above_ground, i) || !(seen.sd > 0)) return;
    const auto ground = ground_below(scene_, seen.image);
    if (!ground || !built_.point_blocks[ground->point]) return;
    const double offset = ground->height - scene_.points[ground->point].position->z();
    network().terms.push_back(height_above_ground_term({Kind::height_above_ground, i}, *pose,
                                                       *built_.point_blocks[ground->point], offset,
                                                       seen.height, std::hypot(seen.sd, ground->sd)));
  }

  void lens_prior(std::size_t i) {
    const LensPrior& prior = seen_.lenses[i];
    if (prior.lens >= scene_.lenses.size())
      throw Error(ErrorCode::input, fmt::format("a prior names lens {}: there are {} lenses", prior.lens,
                                                scene_.lenses.size()));
    const auto block = built_.lens_blocks[prior.lens];
    if (!block) return;
    const int index = lens_parameter(*built_.models[prior.lens], prior.lens, prior.parameter);
    const auto& free = network().blocks[*block].free;
    if (std::ranges::count(free, index) == 0 || !(prior.sd > 0)) return;
    network().terms.push_back(component_term({Kind::lens, i}, *block, index,
                                             network().blocks[*block].value.size(), prior.value, prior.sd));
  }

 private:
  Network& network() { return built_.network; }
  static bool at(const std::vector<bool>& flags, std::size_t i) { return i < flags.size() && flags[i]; }

  // Fixes component `axis` of the centre of a camera.
  void hold(std::size_t pose, int axis, double value) {
    Block& block = network().blocks[pose];
    block.value[4 + axis] = value;
    std::erase(block.free, 3 + axis);
  }

  const Reconstruction& scene_;
  const Observations& seen_;
  const LeftOut& out_;
  BuiltNetwork& built_;
};

}  // namespace

int lens_parameter(const LensModel& model, std::size_t lens, const std::string& name) {
  const auto& names = model.names();
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    throw Error(ErrorCode::input, fmt::format("lens {} has no parameter '{}'", lens, name), "",
                fmt::format("it has {}", fmt::join(names, ", ")));
  return static_cast<int>(found - names.begin());
}

void add_height_bias(const Reconstruction& scene, const Observations& seen, BuiltNetwork& built) {
  const auto posed = [&](const auto& o) { return scene.images[o.image].world_from_camera.has_value(); };
  const bool needed =
      std::ranges::any_of(seen.positions, [&](const auto& o) { return o.biased_height && posed(o); }) ||
      std::ranges::any_of(seen.heights, [&](const auto& o) { return o.biased && posed(o); });
  if (!needed || !(seen.height_bias_sd > 0)) return;
  built.bias_block =
      built.network.add_block(Block::Kind::bias, Eigen::VectorXd::Constant(1, median_bias(scene, seen)), {0});
  if (std::isfinite(seen.height_bias_sd))
    built.network.terms.push_back(
        component_term({Kind::bias}, *built.bias_block, 0, 1, 0, seen.height_bias_sd));
}

void add_observed_cameras(const Reconstruction& scene, const Observations& seen, const ImageOrder& order,
                          const LeftOut& left_out, BuiltNetwork& built) {
  Adder add(scene, seen, left_out, built);
  for (const std::size_t i : order.sort(seen.positions)) add.position(i);
  for (const std::size_t i : order.sort(seen.attitudes)) add.attitude(i);
  for (const std::size_t i : order.sort(seen.ups)) add.up(i);
  for (const std::size_t i : order.sort(seen.heights)) add.height(i);
  for (const std::size_t i : order.sort(seen.heights_above_ground)) add.height_above_ground(i);
  for (std::size_t i = 0; i < seen.lenses.size(); ++i) add.lens_prior(i);
}

}  // namespace waymark::pipeline
