// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/build_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.hpp"
#include "pipeline/reconstruction/adjustment/image_order.hpp"
#include "pipeline/reconstruction/adjustment/observed_cameras.hpp"
#include "pipeline/reconstruction/adjustment/observed_motions.hpp"
#include "pipeline/reconstruction/adjustment/terms.hpp"
#include "pipeline/reconstruction/adjustment/triangulate.hpp"

namespace waymark::pipeline {
namespace {

using Kind = Term::Kind;

/// Builds a network step by step.
class Builder {
 public:
  Builder(const Reconstruction& scene, const Observations& observations, const AdjustmentOptions& options,
          const LeftOut& left_out)
      : scene_(scene), seen_(observations), options_(options), out_(left_out), order_(scene) {
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
    for (const std::size_t i : order_.images())
      if (scene_.images[i].world_from_camera) add_image(i);
    add_motions(scene_, order_, out_, options_.estimate_motions, built_);
    add_height_bias(scene_, seen_, built_);
    add_points();
    add_observed_cameras(scene_, seen_, order_, out_, built_);
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

  // Whole metres near the cameras: subtracting them keeps the digits of northings.
  void choose_origin() {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
    for (const std::size_t i : order_.images())
      if (const auto& pose = scene_.images[i].world_from_camera) sum += pose->translation(), ++count;
    if (count < 1)
      throw Error(ErrorCode::input, "no image has a pose, so there is nothing to adjust", "",
                  "find poses first");
    network().origin = (sum / count).array().floor();
  }

  void add_lens(std::size_t lens) {
    if (built_.lens_blocks[lens]) return;
    auto& model = built_.models[lens];
    if (lens < options_.lens_models.size()) model = options_.lens_models[lens];
    if (!model) model = lens_model(scene_.lenses[lens].camera);
    std::vector<int> free;
    if (lens < options_.free_lens_parameters.size())
      for (const std::string& name : options_.free_lens_parameters[lens])
        free.push_back(lens_parameter(*model, lens, name));
    std::ranges::sort(free);
    free.erase(std::unique(free.begin(), free.end()), free.end());
    built_.lens_blocks[lens] =
        network().add_block(Block::Kind::lens, model->parameters(scene_.lenses[lens].camera), free);
  }

  void add_image(std::size_t i) {
    const AdjustedImage& image = scene_.images[i];
    add_lens(image.lens);
    Eigen::VectorXd value(7);
    value.head<4>() = Eigen::Quaterniond(image.world_from_camera->linear()).normalized().coeffs();
    value.tail<3>() = image.world_from_camera->translation() - network().origin;
    const bool fixed = std::ranges::count(options_.fixed_images, i) > 0;
    built_.pose_blocks[i] = network().add_block(
        Block::Kind::pose, value, fixed ? std::vector<int>{} : std::vector<int>{0, 1, 2, 3, 4, 5});
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
      const std::size_t block =
          network().add_block(Block::Kind::point, *point.position - network().origin, {0, 1, 2});
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
      const std::size_t block = network().add_block(Block::Kind::point, start, free);
      built_.control_blocks[i] = block;
      add_marks(Kind::control_mark, i, point.marks, marks, block);
      const Eigen::Vector3d value = point.position - network().origin;
      if (auto term = position_term({Kind::control, i}, {block}, false, value, point.sd))
        network().terms.push_back(std::move(term));
    }
  }

  const Reconstruction& scene_;
  const Observations& seen_;
  const AdjustmentOptions& options_;
  const LeftOut& out_;
  ImageOrder order_;
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
