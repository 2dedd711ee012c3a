// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/find_craters.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "pipeline/craters/bowl_candidates.hpp"
#include "pipeline/craters/filled_image.hpp"
#include "pipeline/craters/rim_refinement.hpp"

namespace waymark {
namespace {

constexpr double kLeastKnown = 2.0 / 3;  // share of a crater's square that must have data

void check(const CraterSearch& search) {
  const auto refuse = [](std::string problem, std::string hint) {
    throw Error(ErrorCode::usage, std::move(problem), "crater search", std::move(hint));
  };
  if (search.sun_angle && !std::isfinite(search.sun_angle->value))
    refuse("the sun angle is not a number",
           "give degrees from the image's x axis (right) towards y (down), or none");
  if (!(search.min_diameter >= 6))
    refuse(fmt::format("min_diameter is {} px", search.min_diameter),
           "craters below 6 px cannot be told from noise");
  if (search.max_diameter != 0 && !(search.max_diameter >= search.min_diameter))
    refuse(fmt::format("max_diameter is {} px, less than min_diameter, {} px", search.max_diameter,
                       search.min_diameter),
           "0 means as large as the image allows");
  if (!(search.min_confidence >= 0 && search.min_confidence <= 1))
    refuse(fmt::format("min_confidence is {}", search.min_confidence), "it is a probability, 0 to 1");
}

// Correlation of an untrained candidate as the probability that it is a crater: logistic, fitted on made-up
// scenes.
double probability_of(double correlation) {
  return 1 / (1 + std::exp(-18 * (correlation - 0.66)));
}

Detection detection_of(const CraterCandidate& c, const Pixels& image, Radians sun, TypeId type) {
  Detection d;
  d.type = type;
  d.outline = {.x = c.x, .y = c.y, .major = c.diameter, .minor = c.diameter, .angle = 0};
  double centre_sd = 0.06 * c.diameter;
  d.diameter_sd = 0.08 * c.diameter;
  if (const auto rim = refine_rim(image, c, sun)) {
    d.outline = rim->ellipse;
    centre_sd = std::hypot(rim->centre_sd, 0.03 * c.diameter);
    d.diameter_sd = std::hypot(rim->diameter_sd, 0.05 * c.diameter);
  }
  d.covariance = Eigen::Matrix2d::Identity() * centre_sd * centre_sd;
  d.confidence = std::clamp(c.score, 1e-6, 1.0);
  return d;
}

}  // namespace

std::vector<Detection> find_craters(const Pixels& image, const CraterSearch& search) {
  check(search);
  if (std::min(image.columns(), image.rows()) < 16) return {};
  const FilledImage whole = filled(image);
  if (whole.flat) return {};
  std::optional<Radians> sun = search.sun_angle;
  if (!sun)
    if (const auto estimate = estimate_crater_sun_angle(image)) sun = estimate->angle;
  if (!sun) return {};

  const double side = double(std::min(image.columns(), image.rows()));
  const double largest = search.max_diameter > 0 ? search.max_diameter : 0.6 * side;
  auto candidates = suppress_overlaps(bowl_candidates(whole.pixels, {.sun_angle = *sun,
                                                                     .min_diameter = search.min_diameter,
                                                                     .max_diameter = largest,
                                                                     .min_correlation = 0.5}));
  std::vector<Detection> found;
  for (CraterCandidate& c : candidates) {
    c.score = probability_of(c.score);
    if (c.score < search.min_confidence || whole.known(c.x, c.y, c.diameter) < kLeastKnown) continue;
    Detection d = detection_of(c, whole.pixels, *sun, search.type);
    const double diameter = d.outline.diameter();
    if (diameter >= search.min_diameter && diameter <= largest) found.push_back(d);
  }
  return found;
}

}  // namespace waymark
