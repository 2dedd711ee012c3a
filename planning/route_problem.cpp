// SPDX-License-Identifier: Apache-2.0
#include "planning/route_problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

namespace waymark::planning {
namespace {

constexpr std::array<int, kHeadings> kColumnStep{1, 1, 0, -1, -1, -1, 0, 1},
    kRowStep{0, 1, 1, 1, 0, -1, -1, -1};

}  // namespace

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

std::vector<double> distances_to(const RouteCells& cells, const std::vector<char>& passable,
                                 const std::vector<std::int64_t>& goals) {
  std::vector<double> distance(slot(cells.count()), std::numeric_limits<double>::infinity());
  // Dijkstra without a heap: steps have two lengths, and what is appended after steps of one length never
  // decreases, so the nearest open cell is in front of one of two queues.
  using Entry = std::pair<double, std::int64_t>;
  std::array<std::deque<Entry>, 2> open;
  for (const std::int64_t goal : goals) distance[slot(goal)] = 0, open[0].emplace_back(0, goal);
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

std::vector<double> distances_to(const RouteCells& cells, const std::vector<char>& passable,
                                 std::int64_t to) {
  return distances_to(cells, passable, std::vector{to});
}

}  // namespace waymark::planning
