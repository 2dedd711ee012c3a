// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/bowl_verification.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "pipeline/craters/rim_refinement.hpp"
#include "pipeline/vision/class_share.hpp"

namespace waymark {
namespace {

// Set on HRSC tile 1_24 (which no other figure of ours then counts as unseen), a grid of three values each.
constexpr double kTemperature = 0.5;  // of all evidence: its parts are not independent
constexpr double kPerCorrelation = 20;
constexpr double kEven = 0.59;            // correlation that tells nothing
constexpr double kModelSize = 0.35;       // weight of the model's diameter against the edges'
constexpr double kEvenUntrained = 0.645;  // without a model, which then decides alone
constexpr double kPriorTrust = 0.45;      // how far towards the image's own share of craters

constexpr double kHopeless = 0.03;  // probability at first sight that nothing makes up for

double logistic(double x) {
  return 1 / (1 + std::exp(-x));
}

// What the model makes of a candidate.
struct Opinion {
  double log_odds = 0;  // at the circle it corrects the candidate to
  double diameter = 0;  // of that circle; 0: none
};

double log_odds(double p) {
  return std::log(std::max(1e-6, p) / std::max(1e-6, 1 - p));
}

// Corrected twice, judged at the place that gives. Where there are looks they lead: what they see is cheaper
// to sample than gradients, and both judge that place; they err on different candidates.
Opinion opinion_of(const CraterModel& model, const PatchSource& patches, const CraterCandidate& candidate) {
  const auto judge_at = [&](const CraterCandidate& at) {
    return model.looks.empty() ? judge(model, patches.features(at, candidate.score))
                               : judge(model.looks, patches.look(at, candidate.score));
  };
  const double hopeless = model.looks.empty() ? 0.01 : kHopeless;
  CraterCandidate at = candidate;
  for (int i = 0; i < 2; ++i) {
    const CraterVerdict verdict = judge_at(at);
    if (i == 0 && verdict.probability < hopeless) return {log_odds(verdict.probability), 0};
    at = corrected(at, verdict, patches.sun_angle());
  }
  const double first = log_odds(judge_at(at).probability);
  if (model.looks.empty()) return {first, at.diameter};
  const CraterVerdict second = judge(model, patches.features(at, candidate.score));
  return {(first + log_odds(second.probability)) / 2, at.diameter * std::exp(second.log_size / 2)};
}

// The steepest change of brightness lies inside the crest of a worn rim; the model has learnt by how much.
// Its size has a weight of its own, since it knows made-up craters only.
VerifiedBowl with_rim(const Pixels& image, const CraterCandidate& c, Radians sun, double model_diameter) {
  VerifiedBowl bowl{c,
                    {.x = c.x, .y = c.y, .major = c.diameter, .minor = c.diameter, .angle = 0},
                    0.08 * c.diameter,
                    0.1 * c.diameter};
  if (const auto rim = refine_rim(image, c, sun)) {
    bowl.outline = rim->ellipse;
    bowl.centre_sd = std::hypot(rim->centre_sd, 0.03 * c.diameter);
    bowl.diameter_sd = std::hypot(rim->diameter_sd, 0.05 * c.diameter);
    if (model_diameter > 0) {
      const double ratio = std::clamp(model_diameter / rim->ellipse.diameter(), 0.7, 1.5);
      const double grow = std::pow(ratio, kModelSize);
      bowl.outline.major *= grow, bowl.outline.minor *= grow;
    }
    bowl.circle = {rim->ellipse.x, rim->ellipse.y, bowl.outline.diameter(), c.score};
  }
  return bowl;
}

}  // namespace

std::vector<VerifiedBowl> verify_bowls(const FilledImage& image, Radians sun_angle,
                                       const std::vector<CraterCandidate>& candidates,
                                       const CraterModel* model, double min_probability) {
  const PatchSource patches(image.pixels, sun_angle);
  std::vector<double> evidence(candidates.size());
  std::vector<Opinion> opinions(candidates.size());
  tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
    const CraterCandidate& c = candidates[i];
    const double correlation = (patches.slope_correlation(c) + c.score) / 2;
    // What correlates this little is never seen to pass, whatever the model says.
    const bool hopeless = correlation < kEven - 0.09;
    if (model) opinions[i] = hopeless ? Opinion{-4.6, 0} : opinion_of(*model, patches, c);
    evidence[i] = model ? kTemperature * (opinions[i].log_odds + kPerCorrelation * (correlation - kEven))
                        : kPerCorrelation * (correlation - kEvenUntrained);
  });
  const double odds = model ? kPriorTrust * share_shift(evidence, 0.5) : 0;
  std::vector<CraterCandidate> likely;
  std::vector<double> sizes;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (const double p = logistic(evidence[i] + odds); p >= min_probability) {
      likely.push_back(candidates[i]);
      sizes.push_back(opinions[i].diameter);
      likely.back().score = p;
    }
  std::vector<VerifiedBowl> bowls(likely.size());
  tbb::parallel_for(std::size_t{0}, likely.size(), [&](std::size_t i) {
    bowls[i] = with_rim(image.pixels, likely[i], sun_angle, sizes[i]);
  });
  return bowls;
}

}  // namespace waymark
