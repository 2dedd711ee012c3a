// SPDX-License-Identifier: Apache-2.0
// Small problems of routes, and the slow, obvious twin of their search.
#pragma once
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>
#include "planning/route_problem.hpp"
namespace waymark::test {

inline localization::MapLandmark landmark(double x, double y, double sd = 0.1) {
  localization::MapLandmark l;
  l.at = {x, y};
  l.covariance = Eigen::Matrix2d::Identity() * sd * sd;
  return l;
}

inline planning::LandmarkSensing sensing(double range, double view = 360) {
  return {.coverage = {.range = range, .view = view, .range_sd = 0.1, .bearing_sd = 0.6}};
}

inline planning::RouteProblem problem_of(std::int64_t columns, std::int64_t rows,
                                         const localization::LandmarkGrid& map,
                                         const planning::LandmarkSensing& sensor, double cell = 2) {
  planning::RouteProblem problem;
  const planning::RouteCells cells{.cell = cell, .columns = columns, .rows = rows};
  problem.passable.assign(static_cast<std::size_t>(cells.count()), 1);
  problem.field = planning::make_information_field(cells, problem.passable, map, sensor);
  problem.to = cells.count() - 1;
  problem.start = {0.01, 0, 0.01, 0, 0, 0.001};
  return problem;
}

/// Returns 25 landmarks in a square of 80 m.
inline localization::LandmarkGrid scattered_landmarks(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<localization::MapLandmark> marks;
  for (int i = 0; i < 25; ++i) marks.push_back(landmark(80 * uniform(random), 80 * uniform(random)));
  return localization::LandmarkGrid(marks);
}

/// The cheapest of all paths that visit no cell twice.
inline double by_enumeration(const planning::RouteProblem& problem, double max_sd, double weight = 0) {
  const planning::RouteCells& cells = problem.field.cells;
  double best = std::numeric_limits<double>::infinity();
  std::vector<char> visited(static_cast<std::size_t>(cells.count()), 0);
  const std::function<void(std::int64_t, int, const planning::Symmetric3&, double)> visit =
      [&](std::int64_t cell, int heading, const planning::Symmetric3& p, double cost) {
        if (cost >= best) return;
        if (cell == problem.to) {
          best = cost;
          return;
        }
        visited[static_cast<std::size_t>(cell)] = 1;
        for (int h = 0; h < planning::kHeadings; ++h) {
          const double angle = h * std::numbers::pi / 4;
          const std::int64_t c = cell % cells.columns + std::lround(std::cos(angle)),
                             r = cell / cells.columns + std::lround(std::sin(angle));
          if (c < 0 || r < 0 || c >= cells.columns || r >= cells.rows) continue;
          const std::int64_t next = r * cells.columns + c;
          if (visited[static_cast<std::size_t>(next)]) continue;
          const double turn =
              heading < 0 ? 0 : std::abs(localization::wrap_angle((h - heading) * std::numbers::pi / 4));
          const planning::Symmetric3 after = planning::step_belief(problem, p, next, h, turn);
          const double sd = planning::position_sd(after),
                       length = cells.cell * (h % 2 ? std::numbers::sqrt2 : 1);
          if (sd > max_sd) continue;
          visit(next, h, after, cost + length * (1 + weight * sd));
        }
        visited[static_cast<std::size_t>(cell)] = 0;
      };
  visit(problem.from, -1, problem.start, 0);
  return best;
}

}  // namespace waymark::test
