// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/particle_weights.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "localization/filters/resampling.hpp"

namespace waymark::localization {
namespace {

using Values = Eigen::Map<const Eigen::ArrayXd>;

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kClose = 0.02;  // ln of the effective sample size over `min_size`
constexpr int kMaxTrials = 30;

struct ExponentTrial {
  double excess;  // ln of the effective sample size over `min_size`
  double slope;   // its derivative with respect to the exponent
};

/// Weights at an exponent, not normalised; `off` is the fit relative to the best.
ExponentTrial evaluate_exponent(const Values& weights, const Eigen::ArrayXd& off, double exponent,
                                double min_size, Eigen::ArrayXd& after) {
  after = weights * (exponent * off).exp();
  const double sum = after.sum(), squares = after.square().sum();
  const double by_sum = (after * off).sum(), by_squares = (after.square() * off).sum();
  return {std::log(sum * sum / (min_size * squares)), 2 * by_sum / sum - 2 * by_squares / squares};
}

}  // namespace

TemperedWeights temper_weights(std::span<const double> weights, std::span<const double> fit,
                               double max_exponent, double min_size) {
  const Values before(weights.data(), std::ssize(weights)), fits(fit.data(), std::ssize(fit));
  const double room = std::log(effective_sample_size(weights) / min_size);
  if (!(room > 0)) return {0, {weights.begin(), weights.end()}};
  const double best = (before > 0).select(fits, -kNone).maxCoeff();
  const Eigen::ArrayXd off = (fits - best).min(0).max(-1e6);
  const double mean = (before * off).sum(), variance = (before * off.square()).sum() - mean * mean;
  // For a small exponent the log of the effective sample size falls by exponent^2 times the variance of the
  // fit. Bad fits slow this down later, so the start is usually too small. Newton steps in ln exponent
  // follow.
  double exponent = std::sqrt(room / std::max(variance, 1e-300));
  if (exponent > 0.4 * max_exponent) exponent = max_exponent;
  double low = 0, high = kNone;
  Eigen::ArrayXd after;
  for (int i = 0; i < kMaxTrials; ++i) {
    const ExponentTrial trial = evaluate_exponent(before, off, exponent, min_size, after);
    if (trial.excess >= 0) low = exponent;
    if (trial.excess >= 0 && (exponent >= max_exponent || trial.excess < kClose)) break;
    if (!(trial.excess >= 0)) high = exponent;
    const double step = trial.slope < 0 ? (kClose / 2 - trial.excess) / (exponent * trial.slope) : 1.5;
    exponent *= std::exp(std::clamp(step, -1.5, 1.5));
    if (high == kNone)
      exponent = std::min(exponent, max_exponent);
    else if (!(exponent > low && exponent < high))
      exponent = low > 0 ? std::sqrt(low * high) : high / 4;
    if (i + 2 == kMaxTrials) exponent = low;
  }
  after /= after.sum();
  return {low, {after.begin(), after.end()}};
}

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
  describe_unseen(option);
}

void WeightOptions::describe_unseen(OptionVisitor& option) {
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
  const auto [min_error, max_error] = std::ranges::minmax_element(errors);
  if (!(*max_error - *min_error > 1e-12 * std::max(1.0, std::abs(*max_error)))) return weights;
  for (std::size_t i = 0; i < errors.size(); ++i) weights[i] = (*max_error - errors[i]) / *max_error;
  return weights;
}

std::vector<double> normalise_log_weights(std::span<const double> log_weights) {
  std::vector<double> weights(log_weights.size());
  double max_log = -kNone, sum = 0;
  for (const double w : log_weights)
    if (w > max_log) max_log = w;
  if (!(max_log > -kNone)) {
    std::ranges::fill(weights, 1 / static_cast<double>(std::max<std::size_t>(1, weights.size())));
    return weights;
  }
  for (std::size_t i = 0; i < weights.size(); ++i)
    sum += weights[i] = log_weights[i] > -kNone ? std::exp(log_weights[i] - max_log) : 0;
  for (double& w : weights) w /= sum;
  return weights;
}

}  // namespace waymark::localization
