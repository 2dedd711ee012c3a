// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
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
};

/// One cell of a route.
struct RouteNode {
  std::int64_t cell = 0;
  int heading = 0;
  Symmetric3 covariance;
};

struct Route {
  std::vector<RouteNode> nodes;  ///< from start to goal
  double cost = 0;               ///< metres, with weighted sd if there is a weight
  double length = 0;             ///< metres
  double worst_sd = 0;           ///< metres, of the position in its worst direction
  double outside = 0;            ///< metres with fewer landmarks than wanted
};

/// Returns the shortest distance over passable cells to `to` from every cell, metres; infinity if there is
/// none. O(cells).
std::vector<double> distances_to(const RouteCells& cells, const std::vector<char>& passable, std::int64_t to);

/// Settings of the search for a limited or weighted sd.
struct SigmaSearch {
  double max_sd = std::numeric_limits<double>::infinity();  ///< metres, nowhere exceeded
  double weight = 0;  ///< metres of detour per metre driven with an sd of 1 m
  int labels = 4;     ///< kept per cell and heading
  double tolerance =
      0.1;  ///< a label is dropped if an earlier one is smaller than (1 + tolerance)^2 times it
  std::size_t max_labels = 30'000'000;
};

/// Returns the cheapest route whose sd keeps the limit; `std::nullopt` if none was found. Label-setting A*
/// over cell and heading with dominance of covariances (Prentice & Roy 2009, Bry & Roy 2011). Exact on the
/// grid for unlimited labels and a tolerance of 0. Ties go to the earlier label.
std::optional<Route> search_by_sigma(const RouteProblem& problem, const SigmaSearch& search);

/// Returns, for each cell, a lower bound of the position's sd over all routes that keep below `max_sd`;
/// infinity for cells that no such route reaches.
std::vector<double> relaxed_sd(const RouteProblem& problem, double max_sd);

/// Returns the largest information per metre of each cell, in any direction and at any heading, 1/m^3.
std::vector<double> max_rate(const InformationField& field);

/// Returns the same bound from the max_rate() of the field, for several limits.
std::vector<double> relaxed_sd(const RouteProblem& problem, double max_sd, const std::vector<double>& rate);

/// Returns the route with the least length at which fewer than `count` landmarks are seen, and of these the
/// shortest (section 6 of the paper). Exact on the grid; `std::nullopt` if there is none.
/// `by_quality`: sums qualities (eq. 8) in place of counting.
std::optional<Route> search_by_landmarks(const RouteProblem& problem, double count, bool by_quality);

/// Returns the covariance after one step between neighbouring cells.
Symmetric3 step_belief(const RouteProblem& problem, const Symmetric3& covariance, std::int64_t to,
                       int heading, double turn);

}  // namespace waymark::planning
