// SPDX-License-Identifier: Apache-2.0
#include "testbed/score_match.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geo/spatial_index.hpp"

namespace waymark::testbed {
namespace {

std::vector<int> order_by(std::size_t count, const auto& key) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) > key(b); });
  return order;
}

std::vector<Eigen::Vector3d> places(std::span<const EvaluatedObject> things) {
  std::vector<Eigen::Vector3d> all;
  for (const EvaluatedObject& t : things) all.emplace_back(t.at.x(), t.at.y(), 0);
  return all;
}

bool alike(double a, double b, double ratio) {
  if (!(ratio > 0) || std::isnan(a) || std::isnan(b)) return true;
  return std::max(a, b) <= ratio * std::min(a, b);
}

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

ObjectMatching by_distance(std::span<const EvaluatedObject> found, std::span<const EvaluatedObject> truth,
                           const MatchRules& rules) {
  ObjectMatching pairing{std::vector<int>(found.size(), -1), std::vector<bool>(found.size(), false)};
  const SpatialIndex index(places(found));
  const auto size = [&](int t) { return std::isnan(truth[at(t)].diameter) ? 0 : truth[at(t)].diameter; };
  for (const int t : order_by(truth.size(), size)) {
    const EvaluatedObject& thing = truth[at(t)];
    const double radius = std::max(rules.distance_fraction * size(t), rules.min_distance);
    int best = -1;
    double nearest = radius;
    for (const std::size_t f : index.within({thing.at.x(), thing.at.y(), 0}, radius)) {
      if (!alike(found[f].diameter, thing.diameter, rules.size_ratio)) continue;
      pairing.near[f] = true;
      if (pairing.truth_index[f] >= 0) continue;
      const double distance = (found[f].at - thing.at).norm();
      if (distance < nearest || best < 0) best = static_cast<int>(f), nearest = distance;
    }
    if (best >= 0) pairing.truth_index[at(best)] = t;
  }
  return pairing;
}

ObjectMatching by_overlap(std::span<const EvaluatedObject> found, std::span<const EvaluatedObject> truth,
                          const MatchRules& rules) {
  ObjectMatching pairing{std::vector<int>(found.size(), -1), std::vector<bool>(found.size(), false)};
  const SpatialIndex index(places(truth));
  double largest = 0;
  for (const EvaluatedObject& t : truth)
    if (t.diameter > largest) largest = t.diameter;
  std::vector<bool> taken(truth.size(), false);
  const auto confidence = [&](int f) { return found[at(f)].confidence.value_or(0); };
  for (const int f : order_by(found.size(), confidence)) {
    const EvaluatedObject& find = found[at(f)];
    if (std::isnan(find.diameter)) continue;
    const double reach = std::min(find.diameter, largest) / 2 + find.diameter / 2;
    int best = -1;
    double max_worth = 0;
    for (const std::size_t t : index.within({find.at.x(), find.at.y(), 0}, reach)) {
      if (std::isnan(truth[t].diameter)) continue;
      const double overlap = circle_overlap((find.at - truth[t].at).norm(), find.diameter, truth[t].diameter);
      if (overlap < rules.min_overlap) continue;
      pairing.near[at(f)] = true;
      // Counted objects take precedence over ignored ones.
      const double worth = overlap + (truth[t].ignored ? 0 : 1);
      if (!taken[t] && worth > max_worth) best = static_cast<int>(t), max_worth = worth;
    }
    if (best < 0) continue;
    taken[at(best)] = true;
    pairing.truth_index[at(f)] = best;
  }
  return pairing;
}

}  // namespace

double circle_overlap(double distance, double diameter_a, double diameter_b) {
  const double a = diameter_a / 2, b = diameter_b / 2, d = distance;
  constexpr double pi = std::numbers::pi;
  double shared = 0;
  if (d <= std::abs(a - b))
    shared = pi * std::min(a, b) * std::min(a, b);
  else if (d < a + b) {
    const double ca = std::clamp((d * d + a * a - b * b) / (2 * d * a), -1.0, 1.0);
    const double cb = std::clamp((d * d + b * b - a * a) / (2 * d * b), -1.0, 1.0);
    const double kite = (-d + a + b) * (d + a - b) * (d - a + b) * (d + a + b);
    shared = a * a * std::acos(ca) + b * b * std::acos(cb) - std::sqrt(std::max(kite, 0.0)) / 2;
  }
  const double all = pi * (a * a + b * b) - shared;
  return all > 0 ? shared / all : 0;
}

ObjectMatching match_objects(std::span<const EvaluatedObject> found, std::span<const EvaluatedObject> truth,
                             const MatchRules& rules) {
  return rules.by == MatchRules::By::distance ? by_distance(found, truth, rules)
                                              : by_overlap(found, truth, rules);
}

}  // namespace waymark::testbed
