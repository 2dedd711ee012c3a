// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/report_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pipeline/reconstruction/adjustment/outliers.hpp"
#include "pipeline/reconstruction/adjustment/solve_network.hpp"
#include "pipeline/reconstruction/adjustment/terms.hpp"
#include "pipeline/reconstruction/adjustment/triangulate.hpp"

namespace waymark::pipeline {
namespace {

double mark_rms(const Network& network, const ControlPoint& point, std::size_t index) {
  double squares = 0, count = 0;
  for (const auto& term : network.terms) {
    Term::Linear linear;
    if (term->kind != Term::Kind::control_mark || term->index != index || !network.linearize(*term, linear))
      continue;
    const double sd = point.marks[term->mark_index].sd;
    squares += linear.residual.squaredNorm() * sd * sd;
    count += 2;
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

// Position less that surveyed; the height is NaN where none was surveyed.
Eigen::Vector3d error_of(const Eigen::Vector3d& position, const ControlPoint& point) {
  Eigen::Vector3d error = position - point.position;
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(point.sd[axis])) error[axis] = std::numeric_limits<double>::quiet_NaN();
  return error;
}

// Statistic of the test of a point's coordinates that were surveyed (Wilson & Hilferty 1931).
double test_of(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance, const Eigen::Vector3d& sd) {
  std::vector<int> known;
  for (int axis = 0; axis < 3; ++axis)
    if (std::isfinite(sd[axis])) known.push_back(axis);
  if (known.empty()) return 0;
  const Eigen::VectorXd misses = error(known), variances = sd.array().square().matrix()(known);
  Eigen::MatrixXd expected = covariance(known, known);
  expected += variances.asDiagonal();
  const double count = static_cast<double>(known.size()), spread = 2 / (9 * count);
  const double squares = misses.dot(expected.inverse() * misses);
  return std::max(0.0, (std::cbrt(squares / count) - (1 - spread)) / std::sqrt(spread));
}

// Length of the coordinates of an error that are known.
double known_length(const Eigen::Vector3d& error) {
  return std::sqrt(error.array().isNaN().select(0, error.array()).square().sum());
}

// Network of one more point, which sees the cameras but does not move them.
std::optional<Network> network_of_point(const Reconstruction& scene, const ControlPoint& point,
                                        std::size_t index, const BuiltNetwork& built) {
  const auto start = triangulate(scene, point.marks);
  if (!start) return std::nullopt;
  Network one;
  one.origin = built.network.origin;
  one.camera_columns = built.network.camera_columns;
  for (const Block& block : built.network.blocks) {
    one.blocks.push_back(block);
    if (block.kind == Block::Kind::point) one.blocks.back().free.clear();
  }
  const std::size_t block = one.blocks.size();
  one.blocks.push_back({Block::Kind::point, start->position - one.origin, {0, 1, 2}, 0});
  for (std::size_t m = 0; m < point.marks.size(); ++m) {
    const Mark& mark = point.marks[m];
    if (built.pose_blocks[mark.image])
      one.terms.push_back(image_mark_term({Term::Kind::control_mark, index, m}, scene, built, mark, block));
  }
  std::vector<std::vector<int>> free;
  for (Block& b : one.blocks) {
    free.push_back(b.free);
    if (b.kind != Block::Kind::point) b.free.clear();
  }
  if (!solve(one, {}).usable) return std::nullopt;
  for (std::size_t i = 0; i < free.size(); ++i) one.blocks[i].free = free[i];
  return one;
}

void report_apart(const Reconstruction& scene, const ControlPoint& point, std::size_t index,
                  const BuiltNetwork& built, const NetworkCovariance& covariance, double sigma0,
                  ControlResult& out) {
  const auto one = network_of_point(scene, point, index, built);
  if (!one) {
    out.note =
        "its marks do not give a position: it needs marks in two or more images with poses, "
        "from different directions";
    return;
  }
  out.position = one->blocks.back().value + one->origin;
  out.error = error_of(*out.position, point);
  out.mark_rms = mark_rms(*one, point, index);
  if (!covariance.determined) return;
  if (const auto found = point_covariance(*one, one->blocks.size() - 1, covariance.cameras)) {
    out.covariance = *found * sigma0 * sigma0;
    out.statistic = test_of(out.error, *out.covariance, point.sd);
  }
}

}  // namespace

std::vector<ControlResult> report_control(const Reconstruction& scene, const Observations& observations,
                                          const BuiltNetwork& built, const NetworkCovariance& covariance,
                                          const LeftOut& left_out, double sigma0) {
  const Network& network = built.network;
  std::vector<ControlResult> all;
  for (std::size_t i = 0; i < observations.control.size(); ++i) {
    const ControlPoint& point = observations.control[i];
    ControlResult one{.name = point.name, .check = point.check};
    if (const auto block = built.control_blocks[i]) {
      one.used = true;
      one.position = network.blocks[*block].value + network.origin;
      one.error = error_of(*one.position, point);
      one.mark_rms = mark_rms(network, point, i);
      if (covariance.determined && covariance.points[*block])
        one.covariance = *covariance.points[*block] * sigma0 * sigma0;
      for (const auto& term : network.terms)
        if (term->kind == Term::Kind::control && term->index == i)
          one.statistic = blunder_statistic(network, covariance, *term, sigma0);
    } else {
      report_apart(scene, point, i, built, covariance, sigma0, one);
      if (left_out.control[i])
        one.note = fmt::format(
            "left out: {:.3g} m from where its marks place it; check its coordinates, its "
            "name and its marks",
            known_length(one.error));
    }
    all.push_back(one);
  }
  return all;
}

}  // namespace waymark::pipeline
