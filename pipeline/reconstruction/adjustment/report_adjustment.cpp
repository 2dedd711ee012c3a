// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/report_adjustment.hpp"

#include <cmath>

#include "pipeline/reconstruction/adjustment/outliers.hpp"
#include "pipeline/reconstruction/adjustment/report_control.hpp"

namespace waymark::pipeline {
namespace {

struct Sums {
  double squares = 0;
  std::size_t rows = 0;
};

Sums sums_of(const Network& network) {
  Sums sums;
  for (const auto& term : network.terms) {
    Term::Linear linear;
    if (!network.linearize(*term, linear)) continue;
    sums.squares += linear.residual.squaredNorm();
    sums.rows += static_cast<std::size_t>(term->rows);
  }
  return sums;
}

std::size_t unknowns_of(const Network& network) {
  return static_cast<std::size_t>(network.camera_columns + network.point_columns);
}

// Covariance of a block, with zeros for fixed components.
Eigen::MatrixXd covariance_of(const Block& block, const Eigen::MatrixXd& cameras) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(block.changes(), block.changes());
  for (std::size_t i = 0; i < block.free.size(); ++i)
    for (std::size_t j = 0; j < block.free.size(); ++j)
      out(block.free[i], block.free[j]) =
          cameras(block.column + static_cast<Eigen::Index>(i), block.column + static_cast<Eigen::Index>(j));
  return out;
}

void report_lenses(Reconstruction& scene, const BuiltNetwork& built, const Eigen::MatrixXd& cameras,
                   AdjustmentResult& result) {
  result.lenses.resize(scene.lenses.size());
  for (std::size_t i = 0; i < scene.lenses.size(); ++i) {
    AdjustedLens& lens = scene.lenses[i];
    if (!built.lens_blocks[i]) continue;
    const Block& block = built.network.blocks[*built.lens_blocks[i]];
    const auto size = static_cast<Eigen::Index>(block.free.size());
    lens.parameters.clear();
    lens.covariance = cameras.size() > 0 && size > 0 ? cameras.block(block.column, block.column, size, size)
                                                     : Eigen::MatrixXd(0, 0);
    for (Eigen::Index k = 0; k < size; ++k) {
      const int component = block.free[static_cast<std::size_t>(k)];
      const std::string& name = built.models[i]->names()[static_cast<std::size_t>(component)];
      lens.parameters.push_back(name);
      result.lenses[i].push_back(
          {name, block.value[component], cameras.size() > 0 ? std::sqrt(lens.covariance(k, k)) : 0});
    }
  }
}

void report_poses(Reconstruction& scene, const BuiltNetwork& built, const Eigen::MatrixXd& cameras) {
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    scene.images[i].covariance.reset();
    if (!built.pose_blocks[i] || cameras.size() == 0) continue;
    scene.images[i].covariance = covariance_of(built.network.blocks[*built.pose_blocks[i]], cameras);
  }
}

void report_others(const Observations& seen, const BuiltNetwork& built, const NetworkCovariance& covariance,
                   AdjustmentResult& result) {
  const auto others = [&](const char* kind, Term::Kind which, const auto& all) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      ObservationResult one{.kind = kind, .image = all[i].image};
      for (const auto& term : built.network.terms) {
        Term::Linear linear;
        if (term->kind != which || term->index != i || !built.network.linearize(*term, linear)) continue;
        one.used = true;
        one.error = linear.residual;
        one.statistic = blunder_statistic(built.network, covariance, *term, result.sigma0);
      }
      result.others.push_back(one);
    }
  };
  others("position", Term::Kind::position, seen.positions);
  others("attitude", Term::Kind::attitude, seen.attitudes);
  others("up", Term::Kind::up, seen.ups);
  others("height", Term::Kind::height, seen.heights);
  others("height above ground", Term::Kind::height_above_ground, seen.heights_above_ground);
}

}  // namespace

double sigma0_of(const Network& network, int free_datum) {
  const Sums sums = sums_of(network);
  const double redundancy =
      static_cast<double>(sums.rows) - static_cast<double>(unknowns_of(network)) + free_datum;
  return redundancy > 0 ? std::sqrt(sums.squares / redundancy) : 0;
}

void report(Reconstruction& scene, const Observations& observations, const BuiltNetwork& built,
            const NetworkCovariance& covariance, const LeftOut& left_out, AdjustmentResult& result) {
  const Network& network = built.network;
  result.observations = sums_of(network).rows;
  result.unknowns = unknowns_of(network);
  result.free_datum = covariance.free_datum;
  result.determined = covariance.determined;
  result.sigma0 = scene.sigma0 = sigma0_of(network, covariance.free_datum);
  const double variance = result.sigma0 * result.sigma0;
  const Eigen::MatrixXd cameras = covariance.cameras * variance;
  report_lenses(scene, built, cameras, result);
  report_poses(scene, built, cameras);
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    scene.points[i].covariance.reset();
    if (const auto block = built.point_blocks[i]; block && covariance.determined)
      if (const auto& found = covariance.points[*block]) scene.points[i].covariance = *found * variance;
  }
  if (built.bias_block) {
    const Block& bias = network.blocks[*built.bias_block];
    result.height_bias = bias.value[0];
    if (cameras.size() > 0) result.height_bias_sd = std::sqrt(cameras(bias.column, bias.column));
  }
  report_others(observations, built, covariance, result);
  result.control = report_control(scene, observations, built, covariance, left_out, result.sigma0);
  result.joint.matrix = cameras;
  for (const auto& block : built.lens_blocks)
    result.joint.lens_offset.push_back(block ? network.blocks[*block].column : -1);
  for (const auto& block : built.pose_blocks)
    result.joint.pose_offset.push_back(block ? network.blocks[*block].column : -1);
}

}  // namespace waymark::pipeline
