// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/build_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.hpp"
#include "pipeline/reconstruction/adjustment/height_above_ground.hpp"
#include "pipeline/reconstruction/adjustment/shutter_motion.hpp"
#include "pipeline/reconstruction/adjustment/terms.hpp"
#include "pipeline/reconstruction/adjustment/triangulate.hpp"

namespace waymark::pipeline {
namespace {

using Kind = Term::Kind;

/// Order of images that depends on their names only.
struct Order {
  std::vector<std::size_t> images = {}, rank = {};  ///< images by rank, ranks by image
};

Order order_of_images(const Reconstruction& scene) {
  Order order;
  order.images.resize(scene.images.size());
  std::iota(order.images.begin(), order.images.end(), std::size_t{0});
  std::ranges::stable_sort(order.images, {},
                           [&](std::size_t i) -> const std::string& { return scene.images[i].name; });
  order.rank.resize(scene.images.size());
  for (std::size_t r = 0; r < order.images.size(); ++r) order.rank[order.images[r]] = r;
  return order;
}

struct RankedMark {
  std::size_t rank = 0, index = 0;  ///< of the image, and in the point
  double x = 0, y = 0;
  auto key() const { return std::tuple(rank, x, y); }
};

std::vector<RankedMark> ranked_marks(const std::vector<Mark>& marks, const Reconstruction& scene,
                                     const Order& order) {
  std::vector<RankedMark> out;
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (scene.images[marks[i].image].world_from_camera)
      out.push_back({order.rank[marks[i].image], i, marks[i].pixel.x(), marks[i].pixel.y()});
  std::ranges::sort(out, {}, &RankedMark::key);
  return out;
}

/// Builds a network step by step.
class Builder {
 public:
  Builder(const Reconstruction& scene, const Observations& observations, const AdjustmentOptions& options,
          const LeftOut& left_out)
      : scene_(scene),
        seen_(observations),
        options_(options),
        out_(left_out),
        order_(order_of_images(scene)) {
    check_indices();
    built_.models.resize(scene.lenses.size());
    built_.lens_blocks.resize(scene.lenses.size());
    built_.pose_blocks.resize(scene.images.size());
    built_.motion_blocks.resize(scene.images.size());
    built_.point_blocks.resize(scene.points.size());
    built_.control_blocks.resize(observations.control.size());
  }

  BuiltNetwork build() && {
    choose_origin();
    for (const std::size_t i : order_.images)
      if (scene_.images[i].world_from_camera) add_image(i);
    add_motions();
    add_bias();
    add_points();
    for (const std::size_t i : by_image(seen_.positions)) add_position(i);
    for (const std::size_t i : by_image(seen_.attitudes)) add_attitude(i);
    for (const std::size_t i : by_image(seen_.ups)) add_up(i);
    for (const std::size_t i : by_image(seen_.heights)) add_height(i);
    for (const std::size_t i : by_image(seen_.heights_above_ground)) add_height_above_ground(i);
    for (std::size_t i = 0; i < seen_.lenses.size(); ++i) add_lens_prior(i);
    add_control();
    built_.network.number_columns();
    return std::move(built_);
  }

 private:
  Network& network() { return built_.network; }
  static bool at(const std::vector<bool>& flags, std::size_t i) { return i < flags.size() && flags[i]; }

  void check_indices() const {
    const auto image = [&](std::size_t i, const char* what) {
      if (i >= scene_.images.size())
        throw Error(ErrorCode::input,
                    fmt::format("{} of image {}: there are {} images", what, i, scene_.images.size()), "",
                    "number images from 0 as in the reconstruction");
    };
    for (const TiePoint& p : scene_.points)
      for (const Mark& m : p.marks) image(m.image, "a mark");
    for (const ControlPoint& p : seen_.control)
      for (const Mark& m : p.marks) image(m.image, "a mark of a control point");
    for (const auto& o : seen_.positions) image(o.image, "a position");
    for (const auto& o : seen_.attitudes) image(o.image, "an attitude");
    for (const auto& o : seen_.ups) image(o.image, "an upward direction");
    for (const auto& o : seen_.heights) image(o.image, "a height");
    for (const auto& o : seen_.heights_above_ground) image(o.image, "a height above ground");
    for (const AdjustedImage& i : scene_.images)
      if (i.lens >= scene_.lenses.size())
        throw Error(ErrorCode::input, fmt::format("image {} has no lens {}", i.name, i.lens));
  }

  // Observations of one kind in the order of their images.
  template <class Observation>
  std::vector<std::size_t> by_image(const std::vector<Observation>& all) const {
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return order_.rank[all[i].image]; });
    return order;
  }

  // Whole metres near the cameras: subtracting them keeps the digits of northings.
  void choose_origin() {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
    for (const std::size_t i : order_.images)
      if (const auto& pose = scene_.images[i].world_from_camera) sum += pose->translation(), ++count;
    if (count < 1)
      throw Error(ErrorCode::input, "no image has a pose, so there is nothing to adjust", "",
                  "find poses first");
    network().origin = (sum / count).array().floor();
  }

  std::size_t add_block(Block::Kind kind, Eigen::VectorXd value, std::vector<int> free) {
    network().blocks.push_back({kind, std::move(value), std::move(free)});
    return network().blocks.size() - 1;
  }

  void add_lens(std::size_t lens) {
    if (built_.lens_blocks[lens]) return;
    auto& model = built_.models[lens];
    if (lens < options_.lens_models.size()) model = options_.lens_models[lens];
    if (!model) model = lens_model(scene_.lenses[lens].camera);
    std::vector<int> free;
    if (lens < options_.free_lens_parameters.size())
      for (const std::string& name : options_.free_lens_parameters[lens])
        free.push_back(parameter(lens, name));
    std::ranges::sort(free);
    free.erase(std::unique(free.begin(), free.end()), free.end());
    built_.lens_blocks[lens] =
        add_block(Block::Kind::lens, model->parameters(scene_.lenses[lens].camera), free);
  }

  int parameter(std::size_t lens, const std::string& name) const {
    const auto& names = built_.models[lens]->names();
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
      throw Error(ErrorCode::input, fmt::format("lens {} has no parameter '{}'", lens, name), "",
                  fmt::format("it has {}", fmt::join(names, ", ")));
    return static_cast<int>(found - names.begin());
  }

  void add_image(std::size_t i) {
    const AdjustedImage& image = scene_.images[i];
    add_lens(image.lens);
    Eigen::VectorXd value(7);
    value.head<4>() = Eigen::Quaterniond(image.world_from_camera->linear()).normalized().coeffs();
    value.tail<3>() = image.world_from_camera->translation() - network().origin;
    const bool fixed = std::ranges::count(options_.fixed_images, i) > 0;
    built_.pose_blocks[i] =
        add_block(Block::Kind::pose, value, fixed ? std::vector<int>{} : std::vector<int>{0, 1, 2, 3, 4, 5});
  }

  // Motions are unknowns with the expectation of their neighbours as an observation, or held.
  void add_motions() {
    std::vector<std::optional<ExpectedMotion>> expected(scene_.images.size());
    if (options_.estimate_motions) expected = expected_motions(scene_);
    for (const std::size_t i : order_.images) {
      const AdjustedImage& image = scene_.images[i];
      if (!image.world_from_camera || !image.motion) continue;
      Eigen::VectorXd value(6);
      value << image.motion->shift, image.motion->turn;
      std::vector<int> free;
      if (expected[i] && expected[i]->shift_sd > 0 && distance_of(*expected[i]) > 0) free = {0, 1, 2};
      if (expected[i] && expected[i]->turn_sd > 0) free.insert(free.end(), {3, 4, 5});
      built_.motion_blocks[i] = add_block(Block::Kind::motion, value, free);
    }
    for (const std::size_t i : order_.images)
      if (built_.motion_blocks[i] && expected[i]) add_expected_motion(i, *expected[i]);
  }

  // Distance between the outer neighbours that a motion is expected from.
  double distance_of(const ExpectedMotion& expected) const {
    const auto centre = [&](const auto& neighbour) {
      return Eigen::Vector3d(scene_.images[neighbour.first].world_from_camera->translation());
    };
    return (centre(expected.centres.back()) - centre(expected.centres.front())).norm();
  }

  void add_expected_motion(std::size_t image, const ExpectedMotion& expected) {
    constexpr double kDoubt = 10;  // a sudden turn: the images say more of it than the neighbours
    const std::size_t block = *built_.motion_blocks[image];
    const double factor_of_sd = at(out_.motions, image) ? kDoubt : 1;
    BlockIndices of{block};
    std::vector<double> factors;
    for (const auto& [neighbour, factor] : expected.centres) {
      of.push_back(*built_.pose_blocks[neighbour]);
      factors.push_back(factor);
    }
    const double apart = distance_of(expected);
    if (expected.shift_sd > 0 && apart > 0)
      network().terms.push_back(
          shift_term({Kind::motion, image}, of, factors,
                     factor_of_sd * out_.motion_scales.shift * expected.shift_sd / apart));
    if (expected.turn_sd > 0)
      network().terms.push_back(turn_term({Kind::motion, image}, block, expected.motion.turn,
                                          factor_of_sd * out_.motion_scales.turn * expected.turn_sd));
  }

  // Median of observed minus current heights.
  double median_bias() const {
    std::vector<double> all;
    const auto add = [&](std::size_t image, double height, double sd) {
      const auto& pose = scene_.images[image].world_from_camera;
      if (pose && std::isfinite(sd)) all.push_back(height - pose->translation().z());
    };
    for (const auto& o : seen_.positions)
      if (o.biased_height) add(o.image, o.position.z(), o.sd.z());
    for (const auto& o : seen_.heights)
      if (o.biased) add(o.image, o.height, o.sd);
    if (all.empty()) return 0;
    std::ranges::sort(all);
    return all[all.size() / 2];
  }

  void add_bias() {
    const auto posed = [&](const auto& o) { return scene_.images[o.image].world_from_camera.has_value(); };
    const bool needed =
        std::ranges::any_of(seen_.positions, [&](const auto& o) { return o.biased_height && posed(o); }) ||
        std::ranges::any_of(seen_.heights, [&](const auto& o) { return o.biased && posed(o); });
    if (!needed || !(seen_.height_bias_sd > 0)) return;
    built_.bias_block = add_block(Block::Kind::bias, Eigen::VectorXd::Constant(1, median_bias()), {0});
    if (std::isfinite(seen_.height_bias_sd))
      network().terms.push_back(
          component_term({Kind::bias}, *built_.bias_block, 0, 1, 0, seen_.height_bias_sd));
  }

  void add_marks(Kind kind, std::size_t index, const std::vector<Mark>& marks,
                 const std::vector<RankedMark>& ranked, std::size_t block) {
    for (const RankedMark& m : ranked)
      network().terms.push_back(
          image_mark_term({kind, index, m.index}, scene_, built_, marks[m.index], block));
  }

  void add_points() {
    std::vector<std::pair<std::size_t, std::vector<RankedMark>>> points;
    for (std::size_t i = 0; i < scene_.points.size(); ++i) {
      if (!scene_.points[i].position) continue;
      auto marks = ranked_marks(scene_.points[i].marks, scene_, order_);
      if (marks.size() >= 2) points.emplace_back(i, std::move(marks));
    }
    std::ranges::stable_sort(points, [](const auto& a, const auto& b) {
      return std::ranges::lexicographical_compare(a.second, b.second, {}, &RankedMark::key, &RankedMark::key);
    });
    for (const auto& [i, marks] : points) {
      const TiePoint& point = scene_.points[i];
      const std::size_t block = add_block(Block::Kind::point, *point.position - network().origin, {0, 1, 2});
      built_.point_blocks[i] = block;
      add_marks(Kind::tie_mark, i, point.marks, marks, block);
      if (seen_.surface && seen_.surface->height(point.position->x(), point.position->y()))
        network().terms.push_back(surface_term({Kind::surface, i}, block, *seen_.surface, network().origin));
    }
  }

  // Where its marks place the point: a start at wrong coordinates would make outliers of the marks. Fixed
  // components, and all of a point that its marks do not place, start at the coordinates.
  Eigen::Vector3d control_start(const ControlPoint& point, const std::vector<RankedMark>& ranked) {
    std::vector<Mark> marks;
    for (const RankedMark& m : ranked) marks.push_back(point.marks[m.index]);
    Eigen::Vector3d start = point.position;
    const auto found = triangulate(scene_, marks);
    for (int axis = 0; axis < 3 && found; ++axis)
      if (!(point.sd[axis] <= 0)) start[axis] = found->position[axis];
    return start - network().origin;
  }

  void add_control() {
    std::vector<std::size_t> order(seen_.control.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {},
                             [&](std::size_t i) -> const std::string& { return seen_.control[i].name; });
    for (const std::size_t i : order) {
      const ControlPoint& point = seen_.control[i];
      const auto marks = ranked_marks(point.marks, scene_, order_);
      if (point.check || at(out_.control, i) || marks.empty()) continue;
      std::vector<int> free;
      for (int axis = 0; axis < 3; ++axis)
        if (!(point.sd[axis] <= 0)) free.push_back(axis);
      const Eigen::Vector3d start = control_start(point, marks);
      if (!start.allFinite()) continue;  // height unknown, and too few marks
      const std::size_t block = add_block(Block::Kind::point, start, free);
      built_.control_blocks[i] = block;
      add_marks(Kind::control_mark, i, point.marks, marks, block);
      const Eigen::Vector3d value = point.position - network().origin;
      if (auto term = position_term({Kind::control, i}, {block}, false, value, point.sd))
        network().terms.push_back(std::move(term));
    }
  }

  // Fixes component `axis` of the centre of a camera.
  void hold(std::size_t pose, int axis, double value) {
    Block& block = network().blocks[pose];
    block.value[4 + axis] = value;
    std::erase(block.free, 3 + axis);
  }

  void add_position(std::size_t i) {
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

  void add_attitude(std::size_t i) {
    const ObservedAttitude& seen = seen_.attitudes[i];
    if (const auto pose = built_.pose_blocks[seen.image]; pose && !at(out_.attitudes, i))
      network().terms.push_back(attitude_term({Kind::attitude, i}, *pose, seen));
  }

  void add_up(std::size_t i) {
    const ObservedUp& seen = seen_.ups[i];
    if (const auto pose = built_.pose_blocks[seen.image]; pose && !at(out_.ups, i))
      network().terms.push_back(up_term({Kind::up, i}, *pose, seen));
  }

  void add_height(std::size_t i) {
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
  void add_height_above_ground(std::size_t i) {
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

  void add_lens_prior(std::size_t i) {
    const LensPrior& prior = seen_.lenses[i];
    if (prior.lens >= scene_.lenses.size())
      throw Error(ErrorCode::input, fmt::format("a prior names lens {}: there are {} lenses", prior.lens,
                                                scene_.lenses.size()));
    const auto block = built_.lens_blocks[prior.lens];
    if (!block) return;
    const int index = parameter(prior.lens, prior.parameter);
    const auto& free = network().blocks[*block].free;
    if (std::ranges::count(free, index) == 0 || !(prior.sd > 0)) return;
    network().terms.push_back(component_term({Kind::lens, i}, *block, index,
                                             network().blocks[*block].value.size(), prior.value, prior.sd));
  }

  const Reconstruction& scene_;
  const Observations& seen_;
  const AdjustmentOptions& options_;
  const LeftOut& out_;
  Order order_;
  BuiltNetwork built_;
};

}  // namespace

std::unique_ptr<Term> image_mark_term(const Observed& what, const Reconstruction& scene,
                                      const BuiltNetwork& built, const Mark& mark, std::size_t point) {
  const std::size_t lens = scene.images[mark.image].lens, pose = *built.pose_blocks[mark.image];
  if (const auto motion = built.motion_blocks[mark.image])
    return moving_mark_term(what, {*built.lens_blocks[lens], pose, *motion, point}, *built.models[lens], mark,
                            readout_fraction(scene.lenses[lens].camera, mark.pixel.y()));
  return mark_term(what, {*built.lens_blocks[lens], pose, point}, *built.models[lens], mark);
}

BuiltNetwork build_network(const Reconstruction& scene, const Observations& observations,
                           const AdjustmentOptions& options, const LeftOut& left_out) {
  return Builder(scene, observations, options, left_out).build();
}

void write_back(const BuiltNetwork& built, Reconstruction& scene) {
  const Network& network = built.network;
  for (std::size_t i = 0; i < scene.lenses.size(); ++i)
    if (const auto block = built.lens_blocks[i]; block && !network.blocks[*block].free.empty())
      scene.lenses[i].camera =
          built.models[i]->with_parameters(scene.lenses[i].camera, network.blocks[*block].value);
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    if (!built.pose_blocks[i]) continue;
    const Block& block = network.blocks[*built.pose_blocks[i]];
    if (block.free.empty()) continue;
    scene.images[i].world_from_camera = pose_of(block.value.data());
    scene.images[i].world_from_camera->translation() += network.origin;
  }
  for (std::size_t i = 0; i < scene.images.size(); ++i)
    if (const auto block = built.motion_blocks[i]; block && !network.blocks[*block].free.empty())
      scene.images[i].motion = {network.blocks[*block].value.head<3>(),
                                network.blocks[*block].value.tail<3>()};
  for (std::size_t i = 0; i < scene.points.size(); ++i)
    if (const auto block = built.point_blocks[i])
      scene.points[i].position = network.blocks[*block].value + network.origin;
}

}  // namespace waymark::pipeline
