// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <optional>
#include <vector>
#include "planning/route_problem.hpp"
namespace waymark::planning {

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

/// Settings of the search for a limited or weighted sd.
struct SigmaSearch {
  double max_sd = std::numeric_limits<double>::infinity();  ///< metres, nowhere exceeded
  double weight = 0;  ///< metres of detour per metre driven with an sd of 1 m
  int labels = 4;     ///< kept per cell and heading
  double tolerance =
      0.1;  ///< a label is dropped if an earlier one is smaller than (1 + tolerance)^2 times it
  std::size_t max_labels = 30'000'000;
  double max_cost = std::numeric_limits<double>::infinity();  ///< of the route; dearer ones are not wanted
};

/// Returns the cheapest route whose sd keeps the limit; `std::nullopt` if none was found. Label-setting A*
/// over cell and heading with dominance of covariances (Prentice & Roy 2009, Bry & Roy 2011). Exact on the
/// grid for unlimited labels and a tolerance of 0. Ties go to the earlier label.
/// - With a weight, labels are ordered by cost_to_go(): by distances alone nearly all of a map is searched.
std::optional<Route> search_by_sigma(const RouteProblem& problem, const SigmaSearch& search);

/// Returns the route with the least length at which fewer than `count` landmarks are seen, and of these the
/// shortest (section 6 of the paper). Exact on the grid; `std::nullopt` if there is none.
/// `by_quality`: sums qualities (eq. 8) in place of counting.
std::optional<Route> search_by_landmarks(const RouteProblem& problem, double count, bool by_quality);

}  // namespace waymark::planning
