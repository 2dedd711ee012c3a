// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/detection.hpp"
#include "pipeline/craters/crater_model.hpp"
#include "pipeline/craters/filled_image.hpp"
namespace waymark::pipeline {

/// Candidate with a measured rim.
struct VerifiedBowl {
  CraterCandidate circle;  ///< rim; score: probability that it is a crater
  PixelEllipse outline;
  double centre_sd = 0, diameter_sd = 0;  ///< pixels
};

/// Measures the rim of each candidate (score: its correlation) and estimates the probability that it is a
/// crater. The probability combines the correlation before and after, and `model` where there is one. The
/// fraction of craters among the candidates is estimated from the image (Saerens, Latinne & Decaestecker
/// 2002); probabilities are moved half-way towards it. Runs in parallel; the order and the result are
/// deterministic.
std::vector<VerifiedBowl> verify_bowls(const FilledImage& image, Radians sun_angle,
                                       const std::vector<CraterCandidate>& candidates,
                                       const CraterModel* model, double min_probability = 0);

}  // namespace waymark::pipeline
