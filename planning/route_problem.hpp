// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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

/// Steps to the neighbours of cells, as neighbour() has them, by one look-up.
class Moves {
 public:
  Moves(const RouteCells& cells, const std::vector<char>& passable);

  /// Returns the directions in which a cell can be left; bit h: neighbour() in direction h is not -1.
  unsigned from(std::int64_t cell) const { return open_[slot(cell)]; }
  /// Returns the neighbour in a direction in which the cell can be left.
  std::int64_t to(std::int64_t cell, int heading) const { return cell + offsets_[slot(heading)]; }
  double length(int heading) const { return lengths_[slot(heading)]; }  ///< metres, step_length()

 private:
  std::vector<std::uint8_t> open_;
  std::array<std::int64_t, kHeadings> offsets_;
  std::array<double, kHeadings> lengths_;
};

/// Returns the turn between two directions, radians, >= 0.
double turn_between(int from, int to);

/// Cosines of the directions; that of direction h + 6 is the sine of h.
inline const std::array<double, kHeadings> kEast = [] {
  std::array<double, kHeadings> all{};
  for (int h = 0; h < kHeadings; ++h) all[slot(h)] = std::cos(h * std::numbers::pi / 4);
  return all;
}();

/// Returns the covariance after one step between neighbouring cells.
inline Symmetric3 step_belief(const RouteProblem& problem, const Symmetric3& covariance, std::int64_t to,
                              int heading, double turn) {
  const double length = step_length(problem.field.cells, heading);
  const Symmetric3 predicted =
      predict(covariance, {length, kEast[slot(heading)], kEast[slot((heading + 6) % kHeadings)], turn},
              problem.noise);
  const Information& seen = problem.field.get(to, heading);
  if (seen.landmarks == 0) return predicted;
  const Symmetric3& j = seen.rate;
  return update(predicted,
                {j.xx * length, j.xy * length, j.yy * length, j.xt * length, j.yt * length, j.tt * length});
}

/// Returns the shortest distance over passable cells to the nearest of `goals` from every cell, metres;
/// infinity if there is none. O(cells).
std::vector<double> distances_to(const RouteCells& cells, const std::vector<char>& passable,
                                 const std::vector<std::int64_t>& goals);
std::vector<double> distances_to(const RouteCells& cells, const std::vector<char>& passable, std::int64_t to);

}  // namespace waymark::planning
