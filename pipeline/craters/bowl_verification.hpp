// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "core/detection.hpp"
#include "core/units.hpp"
#include "geo/image_source.hpp"
#include "pipeline/craters/crater_candidate.hpp"
#include "pipeline/craters/crater_model.hpp"
#include "pipeline/craters/filled_image.hpp"
#include "pipeline/craters/relief_verifier.hpp"
namespace waymark::pipeline {

/// Rim measured in the image.
struct Rim {
  PixelEllipse ellipse;
  double centre_sd = 0;    ///< pixels, of either coordinate
  double diameter_sd = 0;  ///< pixels
};

/// Measures the rim crest in the image; `std::nullopt` if edges are too few or would move the rim by more
/// than 30 % of the radius.
/// - Along 36 azimuths the rim is at the steepest outward change of brightness, to sub-pixel precision:
///   dark to bright on the sunward side, bright to dark opposite.
/// - The radii are fitted by harmonics of the azimuth up to the second (to first order an ellipse). They are
///   reweighted against outliers (Huber), with a prior at the candidate's circle.
/// - Two passes, the second about the centre of the first. `image` has no NaN.
std::optional<Rim> refine_rim(const Pixels& image, const CraterCandidate& candidate, Radians sun_angle);

/// Candidate with a measured rim.
struct VerifiedBowl {
  CraterCandidate circle;  ///< rim; score: probability that it is a crater
  /// Circle at which the model evaluated the candidate after its corrections; diameter 0: there is no model.
  CraterCandidate corrected = {};
  PixelEllipse outline;
  double centre_sd = 0, diameter_sd = 0;  ///< pixels
};

/// Trained networks that judge bowls.
struct BowlJudges {
  const CraterModel* model = nullptr;        ///< null: the correlation alone decides
  const ReliefVerifier* verifier = nullptr;  ///< second opinion on circles that passed the model's first look
};

/// Measures the rim of each candidate (score: its correlation) and estimates the probability that it is a
/// crater. It combines the correlation before and after with the log odds of the networks; a verifier weighs
/// a third. The fraction of craters among the candidates is estimated from the image (Saerens, Latinne &
/// Decaestecker 2002), and probabilities are moved towards it in part. Runs in parallel; the order and the
/// result are deterministic.
std::vector<VerifiedBowl> verify_bowls(const FilledImage& image, Radians sun_angle,
                                       const std::vector<CraterCandidate>& candidates,
                                       const BowlJudges& judges, double min_probability = 0);

}  // namespace waymark::pipeline
