// SPDX-License-Identifier: Apache-2.0
#include "planning/route_problem.hpp"

#include <algorithm>
#include <array>
#include <bit>
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

Moves::Moves(const RouteCells& cells, const std::vector<char>& passable) : open_(slot(cells.count())) {
  for (int h = 0; h < kHeadings; ++h) {
    offsets_[slot(h)] = kColumnStep[slot(h)] + kRowStep[slot(h)] * cells.columns;
    lengths_[slot(h)] = step_length(cells, h);
  }
  // Where both cells of a step lie within the row, nothing else can stop it but obstacles.
  for (std::int64_t row = 0; row < cells.rows; ++row)
    for (int h = 0; h < kHeadings; ++h) {
      const int dc = kColumnStep[slot(h)], dr = kRowStep[slot(h)];
      if (row + dr < 0 || row + dr >= cells.rows) continue;
      const std::int64_t first = dc < 0 ? 1 : 0, last = cells.columns - (dc > 0 ? 1 : 0);
      const char *const here = passable.data() + row * cells.columns, *const beyond =
                                                                          here + dr * cells.columns;
      std::uint8_t* const open = open_.data() + row * cells.columns;
      for (std::int64_t c = first; c < last; ++c)
        open[c] |= static_cast<std::uint8_t>(
            (beyond[c + dc] != 0 && (h % 2 == 0 || (here[c + dc] != 0 && beyond[c] != 0))) << h);
    }
}

double turn_between(int from, int to) {
  const int eighths = std::abs(from - to) % kHeadings;
  return std::min(eighths, kHeadings - eighths) * std::numbers::pi / 4;
}

std::vector<double> distances_to(const RouteCells& cells, const std::vector<char>& passable,
                                 const std::vector<std::int64_t>& goals) {
  const Moves moves(cells, passable);
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
    for (unsigned left = moves.from(cell); left != 0; left &= left - 1) {
      const int h = std::countr_zero(left);
      const std::int64_t next = moves.to(cell, h);
      const double there = d + moves.length(h);
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
