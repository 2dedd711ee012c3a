// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <utility>
#include "planning/world_beliefs.hpp"
#include "workflows/planning/route.hpp"
#include "workflows/planning/route_progress.hpp"
namespace waymark::workflows {

/// Largest number of searches of a leg: trials of a limit and weights, or a bisection to 1 % and weights.
inline constexpr int kMaxSearches = 16;

/// Searches the legs of one request, one after the other.
struct LegPlanner {
  LegPlanner(const RouteRequest& wanted, localization::LandmarkGrid map, const SensorCoverage& coverage)
      : request(wanted), landmarks(std::move(map)), sensing{.coverage = coverage} {}

  const RouteRequest& request;
  localization::LandmarkGrid landmarks;
  planning::LandmarkSensing sensing;
  planning::RouteProblem problem = {};  ///< of the leg
  planning::Odometry odometry = {};
  std::optional<planning::WorldBeliefs> at_start = {};  ///< of the route
  std::optional<planning::WorldBeliefs> before = {};    ///< at the start of the leg
  bool worlds_agree = true;                             ///< at the start of the leg: all have problem.start
  RouteProgress* progress = nullptr;                    ///< of problem.advanced; null: nobody listens

  /// Returns the largest number of searches of leg().
  int max_searches() const;
  /// Begins a leg between two cells at problem.start: what bounds another leg is forgotten.
  void begin_leg(std::int64_t from, std::int64_t to);
  /// Returns a route of the search with the belief over worlds; `std::nullopt` if there is none. The search
  /// takes all errors of the odometry and all misses of a landmark as independent.
  std::optional<planning::Route> search(const planning::SigmaSearch& wanted) const;
  /// Returns the route that the request asks for; there must be a way. Throws Error{input} for a limit that
  /// is not kept; the message has the smallest one that was reached.
  planning::Route leg();
  /// Returns the shortest route found that keeps a limit. The limit of the search is moved until the route
  /// with the belief over worlds just keeps it.
  std::optional<planning::Route> keep(double limit);
  /// Returns lower bounds of the sd in any world over all routes of the leg that keep a limit.
  std::vector<double> min_sd_in_any_world(double limit) const;

 private:
  std::optional<planning::Route> search_alone(const planning::SigmaSearch& wanted) const;
  planning::Route with_belief(planning::Route route) const;
  planning::Route cheapest(double weight);
  std::vector<planning::Route> weighted();
  planning::Route min_sd_route();
  double min_limit(double limit) const;
  [[noreturn]] void fail_impossible(double min_kept) const;
  [[noreturn]] void fail_limit(double min_sd) const;

  mutable std::vector<double> max_rates_;                        // largest information in any world, by cell
  mutable std::optional<std::pair<double, double>> last_bound_;  // limit of the first leg, its bound
};

}  // namespace waymark::workflows
