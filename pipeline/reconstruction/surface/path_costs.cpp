// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/path_costs.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace waymark::pipeline {
namespace {

using Cost = std::uint16_t;

// L(p, k) = C(p, k) + min(L(q, k), L(q, k +- 1) + P1, min L(q) + P2) - min L(q), eq. 13. `before` has one
// more entry on each side, larger than any cost. Returns the smallest L(p).
Cost extend_path(const std::uint8_t* cost, const Cost* before, Cost lowest, const PathPenalties& p, int steps,
                 Cost* out, Cost* total) {
  const auto small = static_cast<Cost>(p.small);
  const auto jump = static_cast<Cost>(lowest + p.large);
  Cost smallest = 0xffff;
  for (int k = 0; k < steps; ++k) {
    const Cost step = static_cast<Cost>(std::min(before[k - 1], before[k + 1]) + small);
    const Cost best = std::min(std::min(before[k], step), jump);
    const Cost value = static_cast<Cost>(cost[k] + best - lowest);
    out[k] = value;
    total[k] = static_cast<Cost>(total[k] + value);
    smallest = std::min(smallest, value);
  }
  return smallest;
}

// One sweep over the rows serves four directions; the reverse sweep the other four.
class PathSweep {
 public:
  PathSweep(const CostVolume& volume, const PathPenalties& penalties, bool reverse, std::vector<Cost>& total)
      : volume_(volume),
        penalties_(penalties),
        reverse_(reverse),
        total_(total),
        stride_(static_cast<std::size_t>(volume.steps) + 2) {
    const std::size_t nodes = static_cast<std::size_t>(volume.columns) + 2;
    for (auto& direction : above_) direction = {empty(nodes), std::vector<Cost>(nodes, 0)};
    for (auto& direction : here_) direction = {empty(nodes), std::vector<Cost>(nodes, 0)};
    side_[0] = side_[1] = {empty(1), std::vector<Cost>(1, 0)};
  }

  void run() {
    for (int j = 0; j < volume_.rows; ++j) {
      const int row = reverse_ ? volume_.rows - 1 - j : j;
      bool along = false;
      for (int i = 0; i < volume_.columns; ++i) {
        const int column = reverse_ ? volume_.columns - 1 - i : i;
        visit(column, row, j > 0, along);
        along = true;
      }
      std::swap(above_, here_);
    }
  }

 private:
  struct Paths {
    std::vector<Cost> cost;    ///< per node: a guard, the steps, a guard
    std::vector<Cost> lowest;  ///< per node
  };

  std::vector<Cost> empty(std::size_t nodes) const { return std::vector<Cost>(nodes * stride_, kGuard); }

  void visit(int column, int row, bool has_above, bool has_side) {
    const std::uint8_t* cost = &volume_.cost[volume_.at(column, row)];
    Cost* total = &total_[volume_.at(column, row)];
    const std::size_t node = static_cast<std::size_t>(column) + 1;
    for (int d = 0; d < 3; ++d) {
      const int from = column + d - 1;
      const bool inside = has_above && from >= 0 && from < volume_.columns;
      const std::size_t source = static_cast<std::size_t>(from + 1);
      auto& out = here_[static_cast<std::size_t>(d)];
      const auto& in = above_[static_cast<std::size_t>(d)];
      step(cost, total, inside ? &in : nullptr, source, out, node);
    }
    auto& [now, last] = side_;
    step(cost, total, has_side ? &last : nullptr, 0, now, 0);
    std::swap(now, last);
  }

  void step(const std::uint8_t* cost, Cost* total, const Paths* in, std::size_t source, Paths& out,
            std::size_t node) {
    Cost* to = &out.cost[node * stride_ + 1];
    if (in) {
      out.lowest[node] = extend_path(cost, &in->cost[source * stride_ + 1], in->lowest[source], penalties_,
                                     volume_.steps, to, total);
      return;
    }
    for (int k = 0; k < volume_.steps; ++k) {
      to[k] = cost[k];
      total[k] = static_cast<Cost>(total[k] + cost[k]);
    }
    out.lowest[node] = *std::min_element(to, to + volume_.steps);
  }

  static constexpr Cost kGuard = 0x7fff;
  const CostVolume& volume_;
  const PathPenalties& penalties_;
  bool reverse_;
  std::vector<Cost>& total_;
  std::size_t stride_;
  std::array<Paths, 3> above_, here_;
  std::array<Paths, 2> side_;
};

}  // namespace

std::vector<std::uint16_t> sum_path_costs(const CostVolume& volume, const PathPenalties& penalties) {
  std::vector<std::uint16_t> total(volume.cost.size(), 0);
  for (const bool reverse : {false, true}) PathSweep(volume, penalties, reverse, total).run();
  return total;
}

}  // namespace waymark::pipeline
