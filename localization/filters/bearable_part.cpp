// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/bearable_part.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "localization/filters/resampling.hpp"

namespace waymark {
namespace {

using Values = Eigen::Map<const Eigen::ArrayXd>;

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kClose = 0.02;  // ln of the effective count over the least
constexpr int kMostTrials = 30;

struct Trial {
  double excess;  // ln of the effective count over the least
  double slope;   // its derivative by the part
};

/// Weights after a part of the fit, which is `off` from the best; not normalised.
Trial tried(const Values& weights, const Eigen::ArrayXd& off, double part, double least,
            Eigen::ArrayXd& after) {
  after = weights * (part * off).exp();
  const double sum = after.sum(), squares = after.square().sum();
  const double by_sum = (after * off).sum(), by_squares = (after.square() * off).sum();
  return {std::log(sum * sum / (least * squares)), 2 * by_sum / sum - 2 * by_squares / squares};
}

}  // namespace

Borne believed(std::span<const double> weights, std::span<const double> fit, double most, double least) {
  const Values before(weights.data(), std::ssize(weights)), fits(fit.data(), std::ssize(fit));
  const double room = std::log(effective_count(weights) / least);
  if (!(room > 0)) return {0, {weights.begin(), weights.end()}};
  const double best = (before > 0).select(fits, -kNone).maxCoeff();
  const Eigen::ArrayXd off = (fits - best).min(0).max(-1e6);
  const double mean = (before * off).sum(), variance = (before * off.square()).sum() - mean * mean;
  // For a small part the log of the effective count falls by part^2 times the variance of the fit; bad fits
  // make it fall slower later, so this is below the part looked for, most times. Then Newton's steps in ln
  // part.
  double part = std::sqrt(room / std::max(variance, 1e-300));
  if (part > 0.4 * most) part = most;
  double low = 0, high = kNone;
  Eigen::ArrayXd after;
  for (int i = 0; i < kMostTrials; ++i) {
    const Trial trial = tried(before, off, part, least, after);
    if (trial.excess >= 0) low = part;
    if (trial.excess >= 0 && (part >= most || trial.excess < kClose)) break;
    if (!(trial.excess >= 0)) high = part;
    const double step = trial.slope < 0 ? (kClose / 2 - trial.excess) / (part * trial.slope) : 1.5;
    part *= std::exp(std::clamp(step, -1.5, 1.5));
    if (high == kNone)
      part = std::min(part, most);
    else if (!(part > low && part < high))
      part = low > 0 ? std::sqrt(low * high) : high / 4;
    if (i + 2 == kMostTrials) part = low;
  }
  after /= after.sum();
  return {low, {after.begin(), after.end()}};
}

}  // namespace waymark
