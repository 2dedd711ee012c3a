// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/bowl_verification.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pipeline/craters/harmonic_rim.hpp"
#include "pipeline/craters/sample.hpp"
#include "pipeline/vision/class_prior.hpp"

namespace waymark::pipeline {
namespace {

constexpr int kAzimuths = 36;
constexpr double kNearest = 0.6, kFarthest = 1.45;  // radii
constexpr double kExpected = 0.18;                  // sd of the crest about the candidate's circle, radii
constexpr double kSunward = 0.35;  // minimum |cosine| between azimuth and light for an edge to be visible

// Position of the steepest outward change of `sign` brightness along one azimuth.
std::optional<RimPoint> edge(const Pixels& image, const CraterCandidate& c, double azimuth, double sign) {
  const double radius = c.diameter / 2, step = std::max(0.03, 0.5 / radius);  // radii
  const double towards_x = std::cos(azimuth), towards_y = std::sin(azimuth);
  const auto count = static_cast<std::size_t>((kFarthest - kNearest) / step) + 1;
  // Slope over about 0.1 radii or 1.5 px, whichever is larger.
  const double half = std::max(0.06, 0.75 / radius);
  const bool inside = is_inside(image, c.x, c.y, (kFarthest + half) * radius + 1);
  const auto brightness = [&](double r) {
    const double x = c.x + r * radius * towards_x, y = c.y + r * radius * towards_y;
    return inside ? sample_inside(image.cells().data(), image.columns(), x, y) : sample(image, x, y);
  };
  std::vector<double> steepness(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double r = kNearest + double(i) * step, from_circle = (r - 1) / kExpected;
    steepness[i] =
        sign * (brightness(r + half) - brightness(r - half)) * std::exp(-0.5 * from_circle * from_circle);
  }
  const auto best = std::max_element(steepness.begin() + 1, steepness.end() - 1);
  if (!(*best > 0)) return {};
  const double bend = best[-1] - 2 * best[0] + best[1];
  const double offset = bend < 0 ? std::clamp(0.5 * (best[-1] - best[1]) / bend, -1.0, 1.0) : 0;
  return RimPoint{azimuth, kNearest + (double(best - steepness.begin()) + offset) * step, *best};
}

// Tuned on HRSC tile 1_24, which is therefore not a held-out image; a grid of three values each.
constexpr double kTemperature = 0.5;  // of all evidence, whose parts are not independent
constexpr double kPerCorrelation = 20;
constexpr double kNeutralCorrelation = 0.59;  // correlation at which the log odds do not change
constexpr double kModelSize = 0.35;           // weight of the model's diameter against the edges'
constexpr double kNeutralUntrained = 0.645;   // same, where correlation alone decides
constexpr double kPriorWeight = 0.45;         // step towards the image's own fraction of craters, [0, 1]

// Three kinds of evidence weigh the same: convolutional and dense networks of the model, and the verifier.
constexpr double kVerifierWeight = 1.0 / 3;
// The verifier learnt at a fraction of craters that no image has, so its part of the step is whole.
constexpr double kVerifiedPriorWeight = (1 - kVerifierWeight) * kPriorWeight + kVerifierWeight;

// Factor on the final log odds, so that probabilities are those that labelled images show; the decision at
// 0.5 does not depend on it (docs/evaluation/2026-11-23-overlapping-and-filled-craters.md).
constexpr double kSharpness = 1.1;

constexpr double kMinFirstProbability = 0.03;  // candidates below this first probability are discarded

double logistic(double x) {
  return 1 / (1 + std::exp(-x));
}

// Output of the model for a candidate.
struct ModelEstimate {
  double log_odds = 0;                  // at the corrected circle
  double diameter = 0;                  // of that circle by the model; 0: none
  CraterCandidate corrected = {};       // diameter 0: none
  std::optional<double> verified = {};  // log odds of the verifier at that circle
};

double log_odds(double p) {
  return std::log(std::max(1e-6, p) / std::max(1e-6, 1 - p));
}

// Corrects the candidate twice and evaluates it at the result. Convolutional networks, if present, do the
// corrections, since sampling their patch is cheaper than gradients; both evaluate the final position,
// since they err on different candidates.
ModelEstimate model_estimate(const BowlJudges& judges, const PatchSource& patches,
                             const CraterCandidate& candidate) {
  const CraterModel& model = *judges.model;
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
  const CraterFeatures features = patches.features(at, candidate.score);
  ModelEstimate estimate{first, at.diameter, at};
  if (!model.convolution_nets.empty()) {
    const CraterPrediction second = predict(model, features);
    estimate.log_odds = (first + log_odds(second.probability)) / 2;
    estimate.diameter *= std::exp(second.log_size / 2);
  }
  if (judges.verifier) estimate.verified = log_odds(*judges.verifier, features);
  return estimate;
}

// Adds the verifier's opinion where it has one, and moves all log odds towards the fraction of craters among
// the candidates.
void combine(std::vector<double>& evidence, const std::vector<ModelEstimate>& estimates, bool verified) {
  for (std::size_t i = 0; i < evidence.size(); ++i)
    if (const auto& opinion = estimates[i].verified)
      evidence[i] = (1 - kVerifierWeight) * evidence[i] + kVerifierWeight * *opinion;
  const double shift = (verified ? kVerifiedPriorWeight : kPriorWeight) * prior_shift(evidence, 0.5);
  for (double& value : evidence) value += shift;
}

// The steepest change of brightness lies inside the crest of a degraded rim; the model has learnt by how
// much. Its size has a separate weight, since it was trained on synthetic craters only.
VerifiedBowl with_rim(const Pixels& image, const CraterCandidate& c, Radians sun,
                      const ModelEstimate& estimate) {
  VerifiedBowl bowl{.circle = c,
                    .corrected = estimate.corrected,
                    .outline = {.x = c.x, .y = c.y, .major = c.diameter, .minor = c.diameter, .angle = 0},
                    .centre_sd = 0.08 * c.diameter,
                    .diameter_sd = 0.1 * c.diameter};
  if (const auto rim = refine_rim(image, c, sun)) {
    bowl.outline = rim->ellipse;
    bowl.centre_sd = std::hypot(rim->centre_sd, 0.03 * c.diameter);
    bowl.diameter_sd = std::hypot(rim->diameter_sd, 0.05 * c.diameter);
    if (estimate.diameter > 0) {
      const double ratio = std::clamp(estimate.diameter / rim->ellipse.diameter(), 0.7, 1.5);
      const double grow = std::pow(ratio, kModelSize);
      bowl.outline.major *= grow, bowl.outline.minor *= grow;
    }
    bowl.circle = {rim->ellipse.x, rim->ellipse.y, bowl.outline.diameter(), c.score};
  }
  return bowl;
}

}  // namespace

std::optional<Rim> refine_rim(const Pixels& image, const CraterCandidate& candidate, Radians sun_angle) {
  CraterCandidate about = candidate;
  RimShape found;
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<RimPoint> points;
    double total = 0;
    for (int i = 0; i < kAzimuths; ++i) {
      const double azimuth = 2 * std::numbers::pi * i / kAzimuths,
                   facing = std::cos(azimuth - sun_angle.value);
      if (std::abs(facing) < kSunward) continue;
      auto point = edge(image, about, azimuth, facing > 0 ? 1 : -1);
      if (!point) continue;
      total += point->weight;
      point->weight *= std::abs(facing);
      points.push_back(*point);
    }
    if (points.size() < 8) return {};
    found = fit_rim(points, total / double(points.size()));
    const double radius = about.diameter / 2;
    if (pass == 0) {
      about.x += found.terms[1] * radius;
      about.y += found.terms[2] * radius;
      about.diameter *= std::clamp(found.terms[0], 0.75, 1.3);
    }
  }
  const double radius = about.diameter / 2;
  Rim rim;
  rim.ellipse = found.ellipse(about.x, about.y, radius);
  rim.centre_sd = found.centre_sd * radius / std::numbers::sqrt2;
  rim.diameter_sd = 2 * found.radius_sd * radius;
  const double moved = std::hypot(rim.ellipse.x - candidate.x, rim.ellipse.y - candidate.y);
  const double grown = rim.ellipse.diameter() / candidate.diameter;
  if (!(moved < 0.15 * candidate.diameter) || !(grown > 0.7 && grown < 1.35)) return {};
  return rim;
}

std::vector<VerifiedBowl> verify_bowls(const FilledImage& image, Radians sun_angle,
                                       const std::vector<CraterCandidate>& candidates,
                                       const BowlJudges& judges, double min_probability) {
  const CraterModel* const model = judges.model;
  const PatchSource patches(image.pixels, sun_angle);
  std::vector<double> evidence(candidates.size());
  std::vector<ModelEstimate> estimates(candidates.size());
  tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
    const CraterCandidate& c = candidates[i];
    const double correlation = (patches.bowl_correlation(c) + c.score) / 2;
    // Candidates with a correlation this low never pass, whatever the model returns.
    const bool min_first_probability = correlation < kNeutralCorrelation - 0.09;
    if (model)
      estimates[i] = min_first_probability ? ModelEstimate{-4.6, 0} : model_estimate(judges, patches, c);
    evidence[i] =
        model ? kTemperature * (estimates[i].log_odds + kPerCorrelation * (correlation - kNeutralCorrelation))
              : kPerCorrelation * (correlation - kNeutralUntrained);
  });
  if (model) combine(evidence, estimates, judges.verifier != nullptr);
  std::vector<CraterCandidate> likely;
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (const double p = logistic(kSharpness * evidence[i]); p >= min_probability) {
      likely.push_back(candidates[i]);
      index.push_back(i);
      likely.back().score = p;
    }
  std::vector<VerifiedBowl> bowls(likely.size());
  tbb::parallel_for(std::size_t{0}, likely.size(), [&](std::size_t i) {
    bowls[i] = with_rim(image.pixels, likely[i], sun_angle, estimates[index[i]]);
  });
  return bowls;
}

}  // namespace waymark::pipeline
