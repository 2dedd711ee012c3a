// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "planning/route_problem.hpp"
namespace waymark::planning {

/// Returns the largest information per metre in any direction, 1/m^3.
inline double max_rate(const Symmetric3& rate) {
  const double root = position_sd(rate);
  return root * root;
}
/// Returns the largest information per metre of each cell, in any direction and at any heading, 1/m^3.
std::vector<double> max_rate(const InformationField& field);

/// Returns, for each cell, a lower bound of the position's sd over all routes that keep below `max_sd`;
/// infinity for cells that no such route reaches. The larger of two bounds:
/// - the scalar filter that knows the yaw and has the smaller noise and the larger information in all
///   directions;
/// - far from information, the noise of a straight drive from the nearest cell that has some, across it:
///   min(along, across) D + yaw D^3 / 3. No drive between places D apart has less: in the direction from one
///   to the other, the distance still to go takes every value up to D.
std::vector<double> relaxed_sd(const RouteProblem& problem, double max_sd);

/// The least noise and the most information that a drive can have.
struct BestDrive {
  const localization::OdometryNoise& noise;
  const std::vector<double>& rate;  ///< largest information per metre, by cell, 1/m^3
};
/// Returns the same bound for drives that are at best as given; the problem's noise and field do not count.
std::vector<double> relaxed_sd(const RouteProblem& problem, double max_sd, const BestDrive& best);

/// Returns a lower bound of the cost to the goal from each cell; infinity if there is no way.
/// - A metre driven to a cell costs 1 + `weight` x its sd, which is at least `min_sd`.
/// - Dijkstra, O(n log n).
std::vector<double> cost_to_go(const RouteProblem& problem, double weight, const std::vector<double>& min_sd);

}  // namespace waymark::planning
