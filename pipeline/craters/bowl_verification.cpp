// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/bowl_verification.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "pipeline/craters/rim_refinement.hpp"

namespace waymark {
namespace {

// Set on HRSC tile 1_24 (which no other figure of ours then counts as unseen), a grid of three values each.
constexpr double kTemperature = 0.5;  // of all evidence: its parts are not independent
constexpr double kPerCorrelation = 20;
constexpr double kEven = 0.59;        // correlation that tells nothing
constexpr double kPriorTrust = 0.45;  // how far towards the image's own share of craters

double logistic(double x) {
  return 1 / (1 + std::exp(-x));
}

// Log odds of the model at the place it corrects the candidate to.
double model_evidence(const CraterModel& model, const PatchSource& patches,
                      const CraterCandidate& candidate) {
  CraterCandidate at = candidate;
  for (int i = 0; i < 2; ++i) {
    const CraterVerdict verdict = judge(model, patches.features(at, candidate.score));
    if (i == 0 && verdict.probability < 0.01) return -4.6;
    at = corrected(at, verdict, patches.sun_angle());
  }
  const double p = judge(model, patches.features(at, candidate.score)).probability;
  return std::log(std::max(1e-6, p) / std::max(1e-6, 1 - p));
}

VerifiedBowl with_rim(const Pixels& image, const CraterCandidate& c, Radians sun) {
  VerifiedBowl bowl{c,
                    {.x = c.x, .y = c.y, .major = c.diameter, .minor = c.diameter, .angle = 0},
                    0.08 * c.diameter,
                    0.1 * c.diameter};
  if (const auto rim = refine_rim(image, c, sun)) {
    bowl.outline = rim->ellipse;
    bowl.centre_sd = std::hypot(rim->centre_sd, 0.03 * c.diameter);
    bowl.diameter_sd = std::hypot(rim->diameter_sd, 0.05 * c.diameter);
    bowl.circle = {rim->ellipse.x, rim->ellipse.y, rim->ellipse.diameter(), c.score};
  }
  return bowl;
}

// Log odds of the share of craters, by expectation and maximisation from even odds.
double image_odds(const std::vector<double>& evidence) {
  double share = 0.5;
  for (int round = 0; round < 100; ++round) {
    const double odds = std::log(share / (1 - share));
    double craters = 2;  // two of each, imagined: a few candidates prove little
    for (const double e : evidence) craters += logistic(e + odds);
    share = std::clamp(craters / (double(evidence.size()) + 4), 0.02, 0.98);
  }
  return std::log(share / (1 - share));
}

}  // namespace

std::vector<VerifiedBowl> verify_bowls(const FilledImage& image, Radians sun_angle,
                                       const std::vector<CraterCandidate>& candidates,
                                       const CraterModel* model, double min_probability) {
  const PatchSource patches(image.pixels, sun_angle);
  std::vector<double> evidence(candidates.size());
  tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
    const CraterCandidate& c = candidates[i];
    const double correlation = (patches.slope_correlation(c) + c.score) / 2;
    // What correlates this little stays below one in a hundred whatever the model says.
    const bool hopeless = correlation < kEven - 0.14;
    const double seen = !model ? 0 : hopeless ? -4.6 : model_evidence(*model, patches, c);
    evidence[i] = kTemperature * (seen + kPerCorrelation * (correlation - kEven));
  });
  const double odds = kPriorTrust * image_odds(evidence);
  std::vector<CraterCandidate> likely;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (const double p = logistic(evidence[i] + odds); p >= min_probability) {
      likely.push_back(candidates[i]);
      likely.back().score = p;
    }
  std::vector<VerifiedBowl> bowls(likely.size());
  tbb::parallel_for(std::size_t{0}, likely.size(),
                    [&](std::size_t i) { bowls[i] = with_rim(image.pixels, likely[i], sun_angle); });
  return bowls;
}

}  // namespace waymark
