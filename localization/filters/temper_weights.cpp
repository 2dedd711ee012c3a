// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/temper_weights.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "localization/filters/resampling.hpp"

namespace waymark::localization {
namespace {

using Values = Eigen::Map<const Eigen::ArrayXd>;

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kClose = 0.02;  // ln of the effective sample size over `least`
constexpr int kMostTrials = 30;

struct Trial {
  double excess;  // ln of the effective sample size over `least`
  double slope;   // its derivative with respect to the exponent
};

/// Weights at an exponent, not normalised; `off` is the fit relative to the best.
Trial evaluate_exponent(const Values& weights, const Eigen::ArrayXd& off, double exponent, double least,
                        Eigen::ArrayXd& after) {
  after = weights * (exponent * off).exp();
  const double sum = after.sum(), squares = after.square().sum();
  const double by_sum = (after * off).sum(), by_squares = (after.square() * off).sum();
  return {std::log(sum * sum / (least * squares)), 2 * by_sum / sum - 2 * by_squares / squares};
}

}  // namespace

TemperedWeights temper_weights(std::span<const double> weights, std::span<const double> fit, double most,
                               double least) {
  const Values before(weights.data(), std::ssize(weights)), fits(fit.data(), std::ssize(fit));
  const double room = std::log(effective_sample_size(weights) / least);
  if (!(room > 0)) return {0, {weights.begin(), weights.end()}};
  const double best = (before > 0).select(fits, -kNone).maxCoeff();
  const Eigen::ArrayXd off = (fits - best).min(0).max(-1e6);
  const double mean = (before * off).sum(), variance = (before * off.square()).sum() - mean * mean;
  // For a small exponent the log of the effective sample size falls by exponent^2 times the variance of the
  // fit. Bad fits slow this down later, so the start is usually too small. Newton steps in ln exponent
  // follow.
  double exponent = std::sqrt(room / std::max(variance, 1e-300));
  if (exponent > 0.4 * most) exponent = most;
  double low = 0, high = kNone;
  Eigen::ArrayXd after;
  for (int i = 0; i < kMostTrials; ++i) {
    const Trial trial = evaluate_exponent(before, off, exponent, least, after);
    if (trial.excess >= 0) low = exponent;
    if (trial.excess >= 0 && (exponent >= most || trial.excess < kClose)) break;
    if (!(trial.excess >= 0)) high = exponent;
    const double step = trial.slope < 0 ? (kClose / 2 - trial.excess) / (exponent * trial.slope) : 1.5;
    exponent *= std::exp(std::clamp(step, -1.5, 1.5));
    if (high == kNone)
      exponent = std::min(exponent, most);
    else if (!(exponent > low && exponent < high))
      exponent = low > 0 ? std::sqrt(low * high) : high / 4;
    if (i + 2 == kMostTrials) exponent = low;
  }
  after /= after.sum();
  return {low, {after.begin(), after.end()}};
}

}  // namespace waymark::localization
