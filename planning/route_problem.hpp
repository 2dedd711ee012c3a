// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <numbers>
#include <optional>
#include <vector>
#include "planning/information_field.hpp"
namespace waymark::planning {

/// Terrain and information on which routes are searched.
struct RouteProblem {
  std::vector<char> passable;  ///< by cell
  InformationField field;
  localization::OdometryNoise noise;
  std::int64_t from = 0, to = 0;    ///< passable cells
  std::optional<int> heading = {};  ///< at the start; unknown: any, without a turn
  Symmetric3 start;                 ///< covariance at the start
  std::vector<double> to_go = {};   ///< distances_to(`to`); empty: each search computes them
  std::vector<double> min_sd = {};  ///< relaxed_sd() without a limit; empty: weighted searches compute it
  /// Called now and then during a search, and while a route is followed; most searches end before 1.
  Advanced advanced = {};
};

/// Reports the work of a search to RouteProblem::advanced, once for many steps.
class SearchProgress {
 public:
  /// `max_steps`: number of steps after which the search is taken to be done.
  SearchProgress(const RouteProblem& problem, std::int64_t max_steps)
      : advanced_(problem.advanced), max_steps_(max_steps) {}

  void step() {
    if (advanced_ && ++steps_ % kInterval == 0)
      advanced_(std::min(1.0, static_cast<double>(steps_) / static_cast<double>(max_steps_)));
  }

 private:
  static constexpr std::int64_t kInterval = 4096;  // milliseconds
  const Advanced& advanced_;
  std::int64_t max_steps_, steps_ = 0;
};

/// Returns the index of a cell, or of a cell and heading, as containers take it.
inline std::size_t slot(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// Returns the length of a step to the neighbour in a direction, metres.
inline double step_length(const RouteCells& cells, int heading) {
  return heading % 2 ? cells.cell * std::numbers::sqrt2 : cells.cell;
}

/// Returns the neighbour of a cell; -1 if it is not passable, or a diagonal would cut a corner.
std::int64_t neighbour(const RouteCells& cells, const std::vector<char>& passable, std::int64_t cell,
                       int heading);

/// Returns the turn between two directions, radians, >= 0.
double turn_between(int from, int to);

/// Returns the covariance after one step between neighbouring cells.
Symmetric3 step_belief(const RouteProblem& problem, const Symmetric3& covariance, std::int64_t to,
                       int heading, double turn);

/// Returns the shortest distance over passable cells to the nearest of `goals` from every cell, metres;
/// infinity if there is none. O(cells).
std::vector<double> distances_to(const RouteCells& cells, const std::vector<char>& passable,
                                 const std::vector<std::int64_t>& goals);
std::vector<double> distances_to(const RouteCells& cells, const std::vector<char>& passable, std::int64_t to);

}  // namespace waymark::planning
