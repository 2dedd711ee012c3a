// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/leg_planner.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "planning/sd_bounds.hpp"

namespace waymark::workflows {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr int kTrials = 8;                    // searches for the limit of a search
constexpr double kJust = 0.95;                // of a limit: a route that reaches it is not longer than needed
constexpr std::int64_t kManyLabels = 50'000;  // cells up to which a search has more than one label

using planning::Route;
using planning::slot;

}  // namespace

int LegPlanner::max_searches() const {
  return request.keep_landmarks > 0 ? 1 : request.weight > 0 ? 3 : kMaxSearches;
}

void LegPlanner::begin_leg(std::int64_t from, std::int64_t to) {
  if (problem.to_go.empty() || problem.to != to)
    problem.to_go = planning::distances_to(problem.field.cells, problem.passable, to);
  problem.from = from, problem.to = to;
  problem.min_sd.clear();
}

Route LegPlanner::with_belief(Route route) const {
  planning::WorldBeliefs beliefs = *before;
  planning::follow_route(beliefs, problem, landmarks, sensing, route);
  return route;
}

std::optional<Route> LegPlanner::search_alone(const planning::SigmaSearch& wanted) const {
  if (progress) progress->begin_search();
  return planning::search_by_sigma(problem, wanted);
}

std::optional<Route> LegPlanner::search(const planning::SigmaSearch& wanted) const {
  auto route = search_alone(wanted);
  return route ? std::optional(with_belief(std::move(*route))) : std::nullopt;
}

/// Returns the cheapest route. On small maps the number of labels grows until the cost stops to fall: by 0.3
/// % at most where it was measured, in ten times the time.
Route LegPlanner::cheapest(double weight) {
  problem.min_sd = planning::relaxed_sd(problem, kUnlimited);
  auto first = search({.weight = weight, .labels = 1});
  if (!first)  // there is a way, so the search has run out of labels
    throw Error(ErrorCode::input, "the map has too many cells for a route with a weight", request.map,
                "make --cell coarser");
  Route route = std::move(*first);
  if (problem.field.cells.count() > kManyLabels) return route;
  for (const int labels : {4, 8}) {
    auto next = search({.weight = weight, .labels = labels, .max_cost = route.cost * (1 + 1e-9)});
    if (!next || !(next->cost < route.cost - 1e-9)) break;
    route = std::move(*next);
  }
  return route;
}

/// Returns routes that weigh the sd, which the search for a limit does not beyond the limit.
std::vector<Route> LegPlanner::weighted() {
  if (problem.min_sd.empty()) problem.min_sd = planning::relaxed_sd(problem, kUnlimited);
  std::vector<Route> routes;
  for (const double weight : {0.3, 1.0, 3.0, 10.0})
    if (auto route = search({.weight = weight, .labels = 1})) routes.push_back(std::move(*route));
  return routes;
}

std::optional<Route> LegPlanner::keep(double limit) {
  const double shortest = problem.to_go[slot(problem.from)];
  const int labels = problem.field.cells.count() <= kManyLabels ? 4 : 1;
  std::optional<Route> kept;
  double low = 0, high = kUnlimited, asked = limit;
  for (int i = 0; i < kTrials && !(high < 1.02 * low); ++i) {
    auto route = search({.max_sd = asked, .labels = labels});
    // The search is too cautious at most where errors persist; else what it refuses cannot be kept.
    if (!route && i == 0 && (!odometry.drift.any() || min_limit(limit) > limit)) return {};
    const bool keeps = route && route->worst_sd <= limit;
    (route && !keeps ? high : low) = asked;
    if (keeps && (!kept || route->length < kept->length)) kept = std::move(route);
    if (kept && (kept->length < shortest + 1e-6 || kept->worst_sd > kJust * limit)) return kept;
    asked = !(low > 0) ? high / 1.5 : std::isfinite(high) ? std::sqrt(low * high) : 1.5 * low;
  }
  for (Route& route : weighted())
    if (route.worst_sd <= limit && (!kept || route.length < kept->length)) kept = std::move(route);
  return kept;
}

/// Returns the route with the smallest worst sd that was found: by bisection of the limit to 1 %, and among
/// routes that weigh the sd.
Route LegPlanner::min_sd_route() {
  const Route shortest = *search_alone({.labels = 1});
  Route best = with_belief(shortest);
  double low = position_sd(problem.start), high = shortest.worst_sd;
  while (high > 1.01 * low) {
    const double middle = std::sqrt(low * high);
    auto route = search_alone({.max_sd = middle, .labels = 1});
    if (!route) {
      low = middle;
      continue;
    }
    high = std::min(middle, route->worst_sd);
    Route known = with_belief(std::move(*route));
    if (known.worst_sd < best.worst_sd) best = std::move(known);
  }
  for (Route& route : weighted())
    if (route.worst_sd < best.worst_sd) best = std::move(route);
  return best;
}

std::vector<double> LegPlanner::min_sd_in_any_world(double limit) const {
  if (max_rates_.empty())
    max_rates_ = planning::max_rate_in_any_world(problem.field.cells, problem.passable, landmarks, sensing,
                                                 problem.advanced);
  // Persistent errors may be known: they bound nothing.
  return planning::relaxed_sd(problem, limit, {odometry.noise, max_rates_});
}

/// Returns a lower bound of the limits that a route can keep in any world, to 1 %; `limit` if the relaxed
/// test does not exclude it. Beliefs over worlds that start apart have no such bound. A refused limit is
/// asked for twice, so the last answer is kept.
double LegPlanner::min_limit(double limit) const {
  if (!worlds_agree) return limit;
  if (last_bound_ && last_bound_->first == limit) return last_bound_->second;
  const auto excludes = [&](double sd) { return !std::isfinite(min_sd_in_any_world(sd)[slot(problem.to)]); };
  double low = limit, high = limit;
  if (excludes(limit)) {
    while (excludes(high)) low = high, high *= 2;
    while (high > 1.01 * low) {
      const double middle = std::sqrt(low * high);
      (excludes(middle) ? low : high) = middle;
    }
  }
  last_bound_ = {limit, low};
  return low;
}

void LegPlanner::fail_impossible(double min_kept) const {
  const Route shortest = *search({.labels = 1});
  throw Error(
      ErrorCode::input,
      fmt::format("no route keeps the sd of the position below {:g} m", request.limit_sigma), request.map,
      fmt::format("no limit below {:.3g} m can be kept, even if every landmark is seen; the shortest route "
                  "keeps {:.3g} m; --least-sigma seeks the least",
                  min_kept, std::ceil(shortest.worst_sd * 1000) / 1000));
}

void LegPlanner::fail_limit(double min_sd) const {
  std::string hint = fmt::format("the least worst sd that was found is {:.2f} m", min_sd);
  if (worlds_agree)
    hint += fmt::format("; at the goal it cannot be below {:.2f} m",
                        min_sd_in_any_world(kUnlimited)[slot(problem.to)]);
  throw Error(ErrorCode::input,
              fmt::format("no route keeps the sd of the position below {:g} m", request.limit_sigma),
              request.map, hint);
}

Route LegPlanner::leg() {
  if (request.keep_landmarks > 0) {
    auto route = planning::search_by_landmarks(problem, request.keep_landmarks, request.by_quality);
    return with_belief(std::move(*route));  // the caller has found a way
  }
  if (request.min_sigma) return min_sd_route();
  if (!(request.limit_sigma > 0)) return cheapest(request.weight);
  if (auto route = keep(request.limit_sigma)) return *route;
  if (const double min_kept = min_limit(request.limit_sigma); min_kept > request.limit_sigma)
    fail_impossible(min_kept);
  Route safest = min_sd_route();
  if (!(safest.worst_sd <= request.limit_sigma)) fail_limit(safest.worst_sd);
  return safest;
}

}  // namespace waymark::workflows
