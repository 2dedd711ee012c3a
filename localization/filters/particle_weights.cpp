// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/particle_weights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::localization {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

}  // namespace

void WeightOptions::describe(OptionVisitor& option) {
  option("weights", weights,
         {.help = "Weights of particles: likelihood, or eqs. 12-14 of the paper",
          .choices = {"likelihood", "paper"}});
  option("temper", temper,
         {.help = "Exponent of each likelihood; below 1 if errors of successive sightings are correlated",
          .min = 0.01,
          .max = 1});
  option("particle_gate", gate,
         {.help = "Probability that a right pairing passes", .min = 0.5, .max = 0.9999999});
  option("unmatched_cost", unmatched_cost,
         {.help = "paper: cost of a sighting without landmark; negative: the gate"});
  option("expect_unseen", expect_unseen,
         {.help = "likelihood: unseen landmarks in view count against a pose"});
  option("detection", detection,
         {.help = "Probability that a landmark in view is seen", .min = 0.01, .max = 0.999});
  option("view_range", view_range,
         {.help = "expect_unseen: range of the sensor, metres", .min = 0.1, .max = 1e5});
  option("view_angle", view_angle,
         {.help = "expect_unseen: the sensor's whole field of view, radians", .min = 0.01, .max = 6.2831854});
}

std::vector<double> paper_weights(std::span<const double> errors) {
  std::vector<double> weights(errors.size(), 1);
  if (errors.empty()) return weights;
  const auto [least, most] = std::ranges::minmax_element(errors);
  if (!(*most - *least > 1e-12 * std::max(1.0, std::abs(*most)))) return weights;
  for (std::size_t i = 0; i < errors.size(); ++i) weights[i] = (*most - errors[i]) / *most;
  return weights;
}

std::vector<double> normalise_log_weights(std::span<const double> log_weights) {
  std::vector<double> weights(log_weights.size());
  double most = -kNone, sum = 0;
  for (const double w : log_weights)
    if (w > most) most = w;
  if (!(most > -kNone)) {
    std::ranges::fill(weights, 1 / static_cast<double>(std::max<std::size_t>(1, weights.size())));
    return weights;
  }
  for (std::size_t i = 0; i < weights.size(); ++i)
    sum += weights[i] = log_weights[i] > -kNone ? std::exp(log_weights[i] - most) : 0;
  for (double& w : weights) w /= sum;
  return weights;
}

}  // namespace waymark::localization
