// SPDX-License-Identifier: Apache-2.0
#include "planning/sd_bounds.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "planning/bucket_queue.hpp"
namespace waymark::planning {
namespace {

// Ways in eight directions over open ground are at most 1 / cos(pi / 8) times as long as straight ones.
constexpr double kStraight = 0.92387953;

/// Returns the largest variance of the position that a drive from the nearest cell with information, or from
/// the start, has at least.
std::vector<double> variance_far_from_information(const RouteProblem& problem, const BestDrive& best) {
  const RouteCells& cells = problem.field.cells;
  std::vector<std::int64_t> known{problem.from};
  for (std::int64_t i = 0; i < cells.count(); ++i)
    if (best.rate[slot(i)] > 0 && i != problem.from) known.push_back(i);
  std::vector<double> variance = distances_to(cells, std::vector<char>(slot(cells.count()), 1), known);
  const double position = std::min(best.noise.along_per_metre, best.noise.across_per_metre);
  for (double& v : variance) {
    const double d = kStraight * v;
    v = position * d + best.noise.yaw_per_metre * d * d * d / 3;
  }
  return variance;
}

/// Returns the smallest variance of the start's position in its worst direction, given its yaw.
double start_variance(const Symmetric3& p) {
  const double tt = std::max(p.tt, 1e-12);
  Eigen::Matrix2d start;
  start << p.xx - p.xt * p.xt / tt, p.xy - p.xt * p.yt / tt, p.xy - p.xt * p.yt / tt, p.yy - p.yt * p.yt / tt;
  return std::max(1e-12, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(start).eigenvalues()[1]);
}

}  // namespace

std::vector<double> max_rate(const InformationField& field) {
  std::vector<double> rate(slot(field.cells.count()), 0);
  for (std::int64_t i = 0; i < field.cells.count(); ++i)
    for (int h = 0; h < field.headings; ++h)
      rate[slot(i)] = std::max(rate[slot(i)], max_rate(field.get(i, h).rate));
  return rate;
}

std::vector<double> relaxed_sd(const RouteProblem& problem, double max_sd) {
  return relaxed_sd(problem, max_sd, {problem.noise, max_rate(problem.field)});
}

std::vector<double> relaxed_sd(const RouteProblem& problem, double max_sd, const BestDrive& best) {
  // Given the yaw, the largest variance of the position obeys v <- 1 / (1 / (v + q L) + j L): q is the
  // smaller of the odometry's variances, j the largest information in any direction. Both are bounds.
  const RouteCells& cells = problem.field.cells;
  const double q = std::min(best.noise.along_per_metre, best.noise.across_per_metre);
  const std::vector<double> far = variance_far_from_information(problem, best);
  std::vector<double> variance(slot(cells.count()), std::numeric_limits<double>::infinity());
  variance[slot(problem.from)] = start_variance(problem.start);
  // Any order ends at the same values; the smallest variance first takes the fewest steps.
  BucketQueue open(0, std::max(q * cells.cell, 1e-9) / 2);
  open.push({variance[slot(problem.from)], static_cast<std::uint32_t>(problem.from), 0, 0});
  const Moves moves(cells, problem.passable);
  const double max_variance = max_sd * max_sd;
  std::array<double, kHeadings> noise{};
  for (int h = 0; h < kHeadings; ++h) noise[slot(h)] = q * moves.length(h);
  while (!open.empty()) {
    const QueueEntry first = open.pop();
    const std::int64_t cell = first.number;
    if (first.key > variance[slot(cell)]) continue;  // it was reached with less since
    for (unsigned left = moves.from(cell); left != 0; left &= left - 1) {
      const int h = std::countr_zero(left);
      const std::int64_t next = moves.to(cell, h);
      if (far[slot(next)] > max_variance) continue;
      const double predicted = first.key + noise[slot(h)];
      const double gain = best.rate[slot(next)] * moves.length(h);
      // Most steps are no better by far: the quotient is not needed.
      if (variance[slot(next)] * (1 + predicted * gain) < predicted * (1 - 1e-12)) continue;
      const double v = 1 / (1 / predicted + gain);
      if (!(v <= max_variance) || !(v < variance[slot(next)])) continue;
      variance[slot(next)] = v;
      open.push({v, static_cast<std::uint32_t>(next), 0, 0});
    }
  }
  for (std::size_t i = 0; i < variance.size(); ++i) variance[i] = std::sqrt(std::max(variance[i], far[i]));
  return variance;
}

std::vector<double> cost_to_go(const RouteProblem& problem, double weight,
                               const std::vector<double>& min_sd) {
  const RouteCells& cells = problem.field.cells;
  std::vector<double> cost(slot(cells.count()), std::numeric_limits<double>::infinity());
  BucketQueue open(0, 4 * cells.cell);
  const Moves moves(cells, problem.passable);
  cost[slot(problem.to)] = 0;
  open.push({0, static_cast<std::uint32_t>(problem.to), 0, 0});
  while (!open.empty()) {
    const QueueEntry first = open.pop();
    const double there = first.key;
    const std::int64_t cell = first.number;
    if (there > cost[slot(cell)] || !std::isfinite(min_sd[slot(cell)])) continue;
    const double per_metre = 1 + weight * min_sd[slot(cell)];
    for (unsigned left = moves.from(cell); left != 0; left &= left - 1) {
      const int h = std::countr_zero(left);
      const std::int64_t before = moves.to(cell, h);
      const double whole = there + moves.length(h) * per_metre;
      if (whole < cost[slot(before)])
        cost[slot(before)] = whole, open.push({whole, static_cast<std::uint32_t>(before), 0, 0});
    }
  }
  return cost;
}

}  // namespace waymark::planning
