// SPDX-License-Identifier: Apache-2.0
#include "planning/route_search.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numbers>
#include <queue>
#include <utility>

namespace waymark::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array<int, kHeadings> kColumnStep{1, 1, 0, -1, -1, -1, 0, 1},
    kRowStep{0, 1, 1, 1, 0, -1, -1, -1};

std::size_t slot(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

double step_length(const RouteCells& cells, int heading) {
  return heading % 2 ? cells.cell * std::numbers::sqrt2 : cells.cell;
}

/// Returns the neighbour of a cell; -1 if it is not passable, or a diagonal would cut a corner.
std::int64_t neighbour(const RouteCells& cells, const std::vector<char>& passable, std::int64_t cell,
                       int heading) {
  const std::int64_t column = cell % cells.columns + kColumnStep[slot(heading)];
  const std::int64_t row = cell / cells.columns + kRowStep[slot(heading)];
  if (column < 0 || row < 0 || column >= cells.columns || row >= cells.rows) return -1;
  const std::int64_t to = row * cells.columns + column;
  if (!passable[slot(to)]) return -1;
  if (heading % 2 && (!passable[slot(cell + kColumnStep[slot(heading)])] ||
                      !passable[slot(cell + kRowStep[slot(heading)] * cells.columns)]))
    return -1;
  return to;
}

double turn_between(int from, int to) {
  const int eighths = std::abs(from - to) % kHeadings;
  return std::min(eighths, kHeadings - eighths) * std::numbers::pi / 4;
}

struct Label {
  Symmetric3 covariance;
  double cost, length, worst_sd;
  std::int64_t cell;
  std::int32_t parent;
  int heading;
  std::int32_t closed_before = -1;  // of the same cell and heading
};

Route trace(const std::vector<Label>& labels, std::int32_t last) {
  Route route;
  const Label& end = labels[slot(last)];
  route.cost = end.cost, route.length = end.length, route.worst_sd = end.worst_sd;
  for (std::int32_t i = last; i >= 0; i = labels[slot(i)].parent)
    route.nodes.push_back({labels[slot(i)].cell, labels[slot(i)].heading, labels[slot(i)].covariance});
  std::ranges::reverse(route.nodes);
  return route;
}

}  // namespace

std::vector<double> distances_to(const RouteCells& cells, const std::vector<char>& passable,
                                 std::int64_t to) {
  std::vector<double> distance(slot(cells.count()), kInfinity);
  // Dijkstra without a heap: steps have two lengths, and what is appended after steps of one length never
  // decreases, so the nearest open cell is in front of one of two queues.
  using Entry = std::pair<double, std::int64_t>;
  std::array<std::deque<Entry>, 2> open;
  distance[slot(to)] = 0;
  open[0].emplace_back(0, to);
  while (!open[0].empty() || !open[1].empty()) {
    const bool second = open[0].empty() || (!open[1].empty() && open[1].front() < open[0].front());
    const auto [d, cell] = open[second].front();
    open[second].pop_front();
    if (d > distance[slot(cell)]) continue;
    for (int h = 0; h < kHeadings; ++h) {
      const std::int64_t next = neighbour(cells, passable, cell, h);
      if (next < 0) continue;
      const double there = d + step_length(cells, h);
      if (there < distance[slot(next)])
        distance[slot(next)] = there, open[slot(h % 2)].emplace_back(there, next);
    }
  }
  return distance;
}

Symmetric3 step_belief(const RouteProblem& problem, const Symmetric3& covariance, std::int64_t to,
                       int heading, double turn) {
  static const std::array<double, kHeadings> east = [] {
    std::array<double, kHeadings> all{};
    for (int h = 0; h < kHeadings; ++h) all[slot(h)] = std::cos(h * std::numbers::pi / 4);
    return all;
  }();
  const double length = step_length(problem.field.cells, heading);
  const Symmetric3 predicted = predict(
      covariance, {length, east[slot(heading)], east[slot((heading + 6) % kHeadings)], turn}, problem.noise);
  const Symmetric3& j = problem.field.get(to, heading).rate;
  return update(predicted,
                {j.xx * length, j.xy * length, j.yy * length, j.xt * length, j.yt * length, j.tt * length});
}

std::optional<Route> search_by_sigma(const RouteProblem& problem, const SigmaSearch& search) {
  const RouteCells& cells = problem.field.cells;
  const std::vector<double> own =
      problem.to_go.empty() ? distances_to(cells, problem.passable, problem.to) : std::vector<double>();
  const std::vector<double>& to_go = problem.to_go.empty() ? own : problem.to_go;
  const double first_sd = position_sd(problem.start);
  if (to_go[slot(problem.from)] == kInfinity || !(first_sd <= search.max_sd)) return {};
  const double scale = (1 + search.tolerance) * (1 + search.tolerance);
  std::vector<Label> labels;
  // The closed labels of a cell and heading are a list: the last one here, the one before it in the label.
  std::vector<std::int32_t> closed(slot(cells.count() * kHeadings), -1);
  using Entry = std::pair<double, std::int32_t>;  // equal costs: the earlier label first
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto is_dominated = [&](const Label& label) {
    int kept = 0;
    for (std::int32_t i = closed[slot(label.cell * kHeadings + label.heading)]; i >= 0;
         i = labels[slot(i)].closed_before, ++kept)
      if (labels[slot(i)].cost <= label.cost &&
          (labels[slot(i)].covariance == label.covariance ||
           exceeds(label.covariance, labels[slot(i)].covariance, scale)))
        return true;
    return kept >= search.labels;
  };
  const auto push = [&](const Label& label) {
    if (is_dominated(label) || labels.size() >= search.max_labels) return;
    open.emplace(label.cost + to_go[slot(label.cell)], static_cast<std::int32_t>(labels.size()));
    labels.push_back(label);
  };
  for (int h = 0; h < kHeadings; ++h)
    if (!problem.heading || *problem.heading == h) push({problem.start, 0, 0, first_sd, problem.from, -1, h});
  while (!open.empty()) {
    const std::int32_t at = open.top().second;
    open.pop();
    const Label label = labels[slot(at)];
    if (is_dominated(label)) continue;
    if (label.cell == problem.to) return trace(labels, at);
    std::int32_t& last = closed[slot(label.cell * kHeadings + label.heading)];
    labels[slot(at)].closed_before = std::exchange(last, at);
    for (int h = 0; h < kHeadings; ++h) {
      const std::int64_t next = neighbour(cells, problem.passable, label.cell, h);
      if (next < 0 || to_go[slot(next)] == kInfinity) continue;
      const bool first = label.parent < 0 && !problem.heading;
      if (first && h != label.heading) continue;  // any start heading has its own label
      const double turn = turn_between(label.heading, h), length = step_length(cells, h);
      const Symmetric3 covariance = step_belief(problem, label.covariance, next, h, turn);
      const double sd = position_sd(covariance);
      if (!(sd <= search.max_sd)) continue;
      push({covariance, label.cost + length * (1 + search.weight * sd), label.length + length,
            std::max(label.worst_sd, sd), next, at, h});
    }
  }
  return {};
}

std::vector<double> max_rate(const InformationField& field) {
  std::vector<double> rate(slot(field.cells.count()), 0);
  for (std::int64_t i = 0; i < field.cells.count(); ++i)
    for (int h = 0; h < field.headings; ++h) {
      const double sd = position_sd(field.get(i, h).rate);
      rate[slot(i)] = std::max(rate[slot(i)], sd * sd);
    }
  return rate;
}

std::vector<double> relaxed_sd(const RouteProblem& problem, double max_sd) {
  return relaxed_sd(problem, max_sd, max_rate(problem.field));
}

std::vector<double> relaxed_sd(const RouteProblem& problem, double max_sd, const std::vector<double>& rate) {
  // With the yaw known, the smallest variance of the position obeys v <- 1 / (1 / (v + q L) + j L): q is the
  // smaller of the odometry's variances, j the largest information in any direction. Both are bounds.
  const RouteCells& cells = problem.field.cells;
  const double q = std::min(problem.noise.along_per_metre, problem.noise.across_per_metre);
  std::vector<double> variance(slot(cells.count()), kInfinity);
  // The smallest eigenvalue of the start's position given its yaw.
  Eigen::Matrix2d start;
  const Symmetric3& p = problem.start;
  const double tt = std::max(p.tt, 1e-12);
  start << p.xx - p.xt * p.xt / tt, p.xy - p.xt * p.yt / tt, p.xy - p.xt * p.yt / tt, p.yy - p.yt * p.yt / tt;
  variance[slot(problem.from)] =
      std::max(1e-12, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(start).eigenvalues()[0]);
  std::deque<std::int64_t> open{problem.from};
  std::vector<char> is_open(slot(cells.count()), 0);
  while (!open.empty()) {
    const std::int64_t cell = open.front();
    open.pop_front();
    is_open[slot(cell)] = 0;
    for (int h = 0; h < kHeadings; ++h) {
      const std::int64_t next = neighbour(cells, problem.passable, cell, h);
      if (next < 0) continue;
      const double length = step_length(cells, h);
      const double v = 1 / (1 / (variance[slot(cell)] + q * length) + rate[slot(next)] * length);
      if (!(v <= max_sd * max_sd) || !(v < variance[slot(next)] * (1 - 1e-6))) continue;
      variance[slot(next)] = v;
      if (!is_open[slot(next)]) open.push_back(next), is_open[slot(next)] = 1;
    }
  }
  for (double& v : variance) v = std::sqrt(v);
  return variance;
}

std::optional<Route> search_by_landmarks(const RouteProblem& problem, double count, bool by_quality) {
  const RouteCells& cells = problem.field.cells;
  struct Cost {
    double outside = kInfinity, length = kInfinity;
    auto operator<=>(const Cost&) const = default;
  };
  const std::size_t nodes = slot(cells.count() * kHeadings);
  std::vector<Cost> best(nodes);
  std::vector<std::int64_t> parent(nodes, -1);
  using Entry = std::pair<Cost, std::int64_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (int h = 0; h < kHeadings; ++h)
    if (!problem.heading || *problem.heading == h) {
      const std::int64_t node = problem.from * kHeadings + h;
      best[slot(node)] = {0, 0};
      open.emplace(best[slot(node)], node);
    }
  std::int64_t last = -1;
  while (!open.empty()) {
    const auto [cost, node] = open.top();
    open.pop();
    if (cost > best[slot(node)]) continue;
    if (node / kHeadings == problem.to) {
      last = node;
      break;
    }
    for (int h = 0; h < kHeadings; ++h) {
      const std::int64_t next = neighbour(cells, problem.passable, node / kHeadings, h);
      if (next < 0) continue;
      const Information& seen = problem.field.get(next, h);
      const double value = by_quality ? seen.quality : seen.landmarks, length = step_length(cells, h);
      const Cost there{cost.outside + (value >= count ? 0 : length), cost.length + length};
      const std::int64_t to = next * kHeadings + h;
      if (there < best[slot(to)]) {
        best[slot(to)] = there, parent[slot(to)] = node;
        open.emplace(there, to);
      }
    }
  }
  if (last < 0) return {};
  Route route;
  route.outside = best[slot(last)].outside;
  route.cost = route.length = best[slot(last)].length;
  for (std::int64_t node = last; node >= 0; node = parent[slot(node)])
    route.nodes.push_back({node / kHeadings, static_cast<int>(node % kHeadings), {}});
  std::ranges::reverse(route.nodes);
  if (!problem.heading && route.nodes.size() > 1) route.nodes[0].heading = route.nodes[1].heading;
  route.nodes[0].covariance = problem.start;
  route.worst_sd = position_sd(problem.start);
  for (std::size_t i = 1; i < route.nodes.size(); ++i) {
    RouteNode& node = route.nodes[i];
    const RouteNode& before = route.nodes[i - 1];
    node.covariance = step_belief(problem, before.covariance, node.cell, node.heading,
                                  turn_between(before.heading, node.heading));
    route.worst_sd = std::max(route.worst_sd, position_sd(node.covariance));
  }
  return route;
}

}  // namespace waymark::planning
