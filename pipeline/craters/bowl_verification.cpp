// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/bowl_verification.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "pipeline/craters/rim_refinement.hpp"
#include "pipeline/vision/class_prior.hpp"

namespace waymark::pipeline {
namespace {

// Tuned on HRSC tile 1_24, which is therefore not a held-out image; a grid of three values each.
constexpr double kTemperature = 0.5;  // of all evidence, whose parts are not independent
constexpr double kPerCorrelation = 20;
constexpr double kNeutralCorrelation = 0.59;  // correlation at which the log odds do not change
constexpr double kModelSize = 0.35;           // weight of the model's diameter against the edges'
constexpr double kNeutralUntrained = 0.645;   // same, where correlation alone decides
constexpr double kPriorWeight = 0.45;         // step towards the image's own fraction of craters, [0, 1]

constexpr double kMinFirstProbability = 0.03;  // candidates below this first probability are discarded

double logistic(double x) {
  return 1 / (1 + std::exp(-x));
}

// Output of the model for a candidate.
struct ModelEstimate {
  double log_odds = 0;  // at the corrected circle
  double diameter = 0;  // of that circle; 0: none
};

double log_odds(double p) {
  return std::log(std::max(1e-6, p) / std::max(1e-6, 1 - p));
}

// Corrects the candidate twice and evaluates it at the result. Convolutional networks, if present, do the
// corrections, since sampling their patch is cheaper than gradients; both evaluate the final position,
// since they err on different candidates.
ModelEstimate model_estimate(const CraterModel& model, const PatchSource& patches,
                             const CraterCandidate& candidate) {
  const auto predict_at = [&](const CraterCandidate& at) {
    return model.convolution_nets.empty()
               ? predict(model, patches.features(at, candidate.score))
               : predict(model.convolution_nets, patches.wide_patch(at, candidate.score));
  };
  const double min_first_probability = model.convolution_nets.empty() ? 0.01 : kMinFirstProbability;
  CraterCandidate at = candidate;
  for (int i = 0; i < 2; ++i) {
    const CraterPrediction prediction = predict_at(at);
    if (i == 0 && prediction.probability < min_first_probability)
      return {log_odds(prediction.probability), 0};
    at = apply_correction(at, prediction, patches.sun_angle());
  }
  const double first = log_odds(predict_at(at).probability);
  if (model.convolution_nets.empty()) return {first, at.diameter};
  const CraterPrediction second = predict(model, patches.features(at, candidate.score));
  return {(first + log_odds(second.probability)) / 2, at.diameter * std::exp(second.log_size / 2)};
}

// The steepest change of brightness lies inside the crest of a degraded rim; the model has learnt by how
// much. Its size has a separate weight, since it was trained on synthetic craters only.
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
  std::vector<ModelEstimate> estimates(candidates.size());
  tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
    const CraterCandidate& c = candidates[i];
    const double correlation = (patches.slope_correlation(c) + c.score) / 2;
    // Candidates with a correlation this low never pass, whatever the model returns.
    const bool min_first_probability = correlation < kNeutralCorrelation - 0.09;
    if (model)
      estimates[i] = min_first_probability ? ModelEstimate{-4.6, 0} : model_estimate(*model, patches, c);
    evidence[i] =
        model ? kTemperature * (estimates[i].log_odds + kPerCorrelation * (correlation - kNeutralCorrelation))
              : kPerCorrelation * (correlation - kNeutralUntrained);
  });
  const double odds = model ? kPriorWeight * prior_shift(evidence, 0.5) : 0;
  std::vector<CraterCandidate> likely;
  std::vector<double> sizes;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (const double p = logistic(evidence[i] + odds); p >= min_probability) {
      likely.push_back(candidates[i]);
      sizes.push_back(estimates[i].diameter);
      likely.back().score = p;
    }
  std::vector<VerifiedBowl> bowls(likely.size());
  tbb::parallel_for(std::size_t{0}, likely.size(), [&](std::size_t i) {
    bowls[i] = with_rim(image.pixels, likely[i], sun_angle, sizes[i]);
  });
  return bowls;
}

}  // namespace waymark::pipeline
