// SPDX-License-Identifier: Apache-2.0
#include "localization/global/chance_matches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace waymark::localization {
namespace {

constexpr double kStep = 0.5, kMaxInformation = 12, kEqualWeight = 4;  // nats
constexpr std::size_t kShells = 6;                                     // of equal area in the gate

struct Trial {
  double probability = 0, weight = 0;
  std::size_t observed = 0;  // steps
};

// ln of the density of a true match over that of a chance match at a squared distance, plus the weight.
std::size_t steps(double weight, double squares, double gate) {
  return static_cast<std::size_t>(
      std::lround(std::max(0.0, weight + std::log(gate / 2) - squares / 2) / kStep));
}

double middle_of_shell(double squares, double gate) {
  const double shell = std::min(std::floor(squares / gate * kShells), kShells - 1.0);
  return (shell + 0.5) * gate / kShells;
}

// Returns the probability that the sum of independent trials is at least that observed.
double tail(std::span<const Trial> trials, double gate) {
  std::vector<double> density{1}, next;
  std::size_t observed = 0;
  for (const Trial& t : trials) {
    observed += t.observed;
    std::array<std::size_t, kShells> shift;
    for (std::size_t k = 0; k < kShells; ++k)
      shift[k] = steps(t.weight, (static_cast<double>(k) + 0.5) * gate / kShells, gate);
    next.assign(density.size() + shift[0], 0);
    for (std::size_t i = 0; i < density.size(); ++i) {
      next[i] += density[i] * (1 - t.probability);
      for (const std::size_t s : shift) next[i + s] += density[i] * t.probability / kShells;
    }
    density.swap(next);
  }
  double sum = 0;
  for (std::size_t i = density.size(); i-- > observed;) sum += density[i];
  return sum;
}

}  // namespace

double chance_of_matches(std::span<const ChanceMatch> sightings, double gate) {
  std::vector<Trial> equal, informed;
  for (const ChanceMatch& s : sightings) {
    const double p = std::clamp(s.probability, std::exp(-kMaxInformation), 1 - 1e-9);
    const double squares = middle_of_shell(s.squares, gate);
    const auto trial = [&](double weight) {
      return Trial{p, weight, s.is_matched ? steps(weight, squares, gate) : 0};
    };
    equal.push_back(trial(kEqualWeight));
    informed.push_back(trial(-std::log(p)));
  }
  return std::min(1.0, 2 * std::min(tail(equal, gate), tail(informed, gate)));
}

}  // namespace waymark::localization
