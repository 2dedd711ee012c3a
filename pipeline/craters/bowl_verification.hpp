// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/detection.hpp"
#include "pipeline/craters/crater_model.hpp"
#include "pipeline/craters/filled_image.hpp"
namespace waymark {

/// A candidate whose rim has been read.
struct VerifiedBowl {
  CraterCandidate circle;  ///< of the rim; score: probability that it is a crater
  PixelEllipse outline;
  double centre_sd = 0, diameter_sd = 0;  ///< pixels
};

/// Reads the rim of each candidate (score: its correlation) and judges it by correlation before and after,
/// and by the model where there is one. People disagree on how faint a crater counts, and scenes on how many
/// craters they have: the share of craters among an image's candidates is estimated from the image itself
/// (Saerens, Latinne & Decaestecker 2002), and the probabilities are moved half-way towards it. Parallel, in
/// order, deterministic.
std::vector<VerifiedBowl> verify_bowls(const FilledImage& image, Radians sun_angle,
                                       const std::vector<CraterCandidate>& candidates,
                                       const CraterModel* model, double min_probability = 0);

}  // namespace waymark
