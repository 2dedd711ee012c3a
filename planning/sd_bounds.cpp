// SPDX-License-Identifier: Apache-2.0
#include "planning/sd_bounds.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

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
  std::deque<std::int64_t> open{problem.from};
  std::vector<char> is_open(slot(cells.count()), 0);
  while (!open.empty()) {
    const std::int64_t cell = open.front();
    open.pop_front();
    is_open[slot(cell)] = 0;
    for (int h = 0; h < kHeadings; ++h) {
      const std::int64_t next = neighbour(cells, problem.passable, cell, h);
      if (next < 0 || far[slot(next)] > max_sd * max_sd) continue;
      const double length = step_length(cells, h);
      const double v = 1 / (1 / (variance[slot(cell)] + q * length) + best.rate[slot(next)] * length);
      if (!(v <= max_sd * max_sd) || !(v < variance[slot(next)])) continue;
      variance[slot(next)] = v;
      if (!is_open[slot(next)]) open.push_back(next), is_open[slot(next)] = 1;
    }
  }
  for (std::size_t i = 0; i < variance.size(); ++i) variance[i] = std::sqrt(std::max(variance[i], far[i]));
  return variance;
}

std::vector<double> cost_to_go(const RouteProblem& problem, double weight,
                               const std::vector<double>& min_sd) {
  const RouteCells& cells = problem.field.cells;
  std::vector<double> cost(slot(cells.count()), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::int64_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  cost[slot(problem.to)] = 0;
  open.emplace(0, problem.to);
  while (!open.empty()) {
    const auto [there, cell] = open.top();
    open.pop();
    if (there > cost[slot(cell)] || !std::isfinite(min_sd[slot(cell)])) continue;
    const double per_metre = 1 + weight * min_sd[slot(cell)];
    for (int h = 0; h < kHeadings; ++h) {
      const std::int64_t before = neighbour(cells, problem.passable, cell, h);
      if (before < 0) continue;
      const double whole = there + step_length(cells, h) * per_metre;
      if (whole < cost[slot(before)]) cost[slot(before)] = whole, open.emplace(whole, before);
    }
  }
  return cost;
}

}  // namespace waymark::planning
