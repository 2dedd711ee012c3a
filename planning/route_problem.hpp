// SPDX-License-Identifier: Apache-2.0
#pragma once
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
