// SPDX-License-Identifier: Apache-2.0
#include "planning/route_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>
#include <queue>
#include <utility>

#include "planning/sd_bounds.hpp"

namespace waymark::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Label {
  Symmetric3 covariance;
  double cost, length, worst_sd;
  std::int64_t cell;
  std::int32_t parent;
  int heading;
  std::int32_t closed_before = 0;  // of the same node, as in Node

  std::size_t node() const { return slot(cell * kHeadings + heading); }
};

/// Labels of a cell and heading, numbered from 1; 0 is none.
struct Node {
  std::int32_t closed;    // the last; each has the one before it
  std::int32_t kept;      // number of them
  std::int32_t cheapest;  // that was opened
};

/// Returns lower bounds of the cost to the goal.
std::vector<double> bounds_to_go(const RouteProblem& problem, const SigmaSearch& search) {
  if (!(search.weight > 0)) return distances_to(problem.field.cells, problem.passable, problem.to);
  return cost_to_go(problem, search.weight,
                    problem.min_sd.empty() ? relaxed_sd(problem, kInfinity) : problem.min_sd);
}

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

std::optional<Route> search_by_sigma(const RouteProblem& problem, const SigmaSearch& search) {
  const RouteCells& cells = problem.field.cells;
  const bool keeps_distances = !(search.weight > 0) && !problem.to_go.empty();
  const std::vector<double> own = keeps_distances ? std::vector<double>() : bounds_to_go(problem, search);
  const std::vector<double>& to_go = keeps_distances ? problem.to_go : own;
  const double first_sd = position_sd(problem.start);
  if (to_go[slot(problem.from)] == kInfinity || !(first_sd <= search.max_sd)) return {};
  const double scale = (1 + search.tolerance) * (1 + search.tolerance);
  std::vector<Label> labels;
  // Memory of calloc costs nothing until it is touched: most searches touch a small part of the nodes.
  const std::unique_ptr<Node[], decltype(&std::free)> nodes(
      static_cast<Node*>(std::calloc(slot(cells.count() * kHeadings), sizeof(Node))), &std::free);
  if (!nodes) throw std::bad_alloc();
  using Entry = std::pair<double, std::int32_t>;  // equal costs: the earlier label first
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  // Without a limit, the first label that a node opens at the least cost is the one it keeps.
  const bool has_limit = std::isfinite(search.max_sd), keeps_cheapest = !has_limit && search.labels == 1;
  const auto is_dominated_at = [&](const Label& label, int heading, double turn_noise) {
    for (std::int32_t i = nodes[slot(label.cell * kHeadings + heading)].closed; i > 0;
         i = labels[slot(i - 1)].closed_before) {
      if (!(labels[slot(i - 1)].cost <= label.cost)) continue;
      Symmetric3 earlier = labels[slot(i - 1)].covariance;
      earlier.tt += turn_noise;
      if (earlier == label.covariance || exceeds(label.covariance, earlier, scale)) return true;
    }
    return false;
  };
  const auto is_dominated = [&](const Label& label) {
    if (nodes[label.node()].kept >= search.labels || is_dominated_at(label, label.heading, 0)) return true;
    if (!has_limit) return false;
    // A turn costs no way: a label of another heading dominates if it does so after the turn to this one.
    // What keeps a limit depends on covariances more than on cost, so places are left for smaller ones.
    for (int h = 1; h < kHeadings; ++h) {
      const int heading = (label.heading + h) % kHeadings;
      const double turn = turn_between(label.heading, heading);
      if (is_dominated_at(label, heading, problem.noise.yaw_per_radian * turn)) return true;
    }
    return false;
  };
  const auto push = [&](const Label& label) {
    const double whole = label.cost + to_go[slot(label.cell)];
    if (whole > search.max_cost || labels.size() >= search.max_labels || is_dominated(label)) return;
    const auto index = static_cast<std::int32_t>(labels.size());
    if (keeps_cheapest) {
      std::int32_t& cheapest = nodes[label.node()].cheapest;
      if (cheapest > 0 && !(label.cost < labels[slot(cheapest - 1)].cost)) return;
      cheapest = index + 1;
    }
    open.emplace(whole, index);
    labels.push_back(label);
  };
  for (int h = 0; h < kHeadings; ++h)
    if (!problem.heading || *problem.heading == h) push({problem.start, 0, 0, first_sd, problem.from, -1, h});
  SearchProgress progress(problem, std::min(static_cast<std::int64_t>(search.max_labels),
                                            cells.count() * kHeadings * search.labels));
  while (!open.empty()) {
    progress.step();
    const std::int32_t at = open.top().second;
    open.pop();
    const Label label = labels[slot(at)];
    if (is_dominated(label)) continue;
    if (label.cell == problem.to) return trace(labels, at);
    Node& node = nodes[label.node()];
    labels[slot(at)].closed_before = std::exchange(node.closed, at + 1);
    ++node.kept;
    for (int h = 0; h < kHeadings; ++h) {
      const std::int64_t next = neighbour(cells, problem.passable, label.cell, h);
      if (next < 0 || to_go[slot(next)] == kInfinity ||
          nodes[slot(next * kHeadings + h)].kept >= search.labels)
        continue;
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
  SearchProgress progress(problem, cells.count() * kHeadings);
  while (!open.empty()) {
    progress.step();
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
