// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/find_craters.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "pipeline/craters/bowl_candidates.hpp"
#include "pipeline/craters/bowl_suppression.hpp"
#include "pipeline/craters/bowl_verification.hpp"
#include "pipeline/craters/edge_pairs.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kMinCorrelation = 0.5;
constexpr double kNeverSure = 2;       // scores without a model are no probabilities
constexpr double kMinKnown = 2.0 / 3;  // minimum fraction of data in a crater's square

void check(const CraterSearch& search) {
  const auto refuse = [](std::string problem, std::string hint) {
    throw Error(ErrorCode::usage, std::move(problem), "crater search", std::move(hint));
  };
  if (search.sun_angle && !std::isfinite(search.sun_angle->value))
    refuse("the sun angle is not a number",
           "give degrees from the image's x axis (right) towards y (down), or none");
  if (!(search.min_diameter >= 6))
    refuse(fmt::format("min_diameter is {} px", search.min_diameter),
           "craters below 6 px cannot be distinguished from noise");
  if (search.max_diameter != 0 && !(search.max_diameter >= search.min_diameter))
    refuse(fmt::format("max_diameter is {} px, less than min_diameter, {} px", search.max_diameter,
                       search.min_diameter),
           "0 means as large as the image allows");
  if (!(search.min_confidence >= 0 && search.min_confidence <= 1))
    refuse(fmt::format("min_confidence is {}", search.min_confidence), "it is a probability, 0 to 1");
}

struct Sizes {
  double smallest, largest;  // pixels
};

Detection detection_of(const VerifiedBowl& bowl, TypeId type) {
  Detection d;
  d.type = type;
  d.outline = bowl.outline;
  d.covariance = Eigen::Matrix2d::Identity() * bowl.centre_sd * bowl.centre_sd;
  d.diameter_sd = bowl.diameter_sd;
  d.confidence = std::clamp(bowl.circle.score, 1e-6, 1.0);
  return d;
}

std::vector<VerifiedBowl> bowls_in(const FilledImage& image, Radians sun, const CraterSearch& search,
                                   const Sizes& sizes) {
  const auto candidates =
      suppress_overlaps(bowl_candidates(image.pixels, {.sun_angle = sun,
                                                       .limits = {.min_diameter = 0.9 * sizes.smallest,
                                                                  .max_diameter = sizes.largest,
                                                                  .min_correlation = kMinCorrelation}}),
                        0.5);
  BowlJudges judges;
  if (search.verify) judges.model = &built_in_crater_model();
  if (search.verify && search.second_opinion)
    judges.verifier = search.verifier ? search.verifier : &built_in_relief_verifier();
  return verify_bowls(image, sun, candidates, judges, search.min_confidence);
}

}  // namespace

std::vector<Detection> find_craters(const Pixels& image, const CraterSearch& search) {
  check(search);
  if (std::min(image.columns(), image.rows()) < 16) return {};
  const FilledImage whole = fill_holes(image);
  if (whole.flat) return {};
  std::optional<Radians> sun = search.sun_angle;
  if (!sun)
    if (const auto estimate = estimate_crater_sun_angle(image)) sun = estimate->angle;
  if (!sun) return {};

  const double side = double(std::min(image.columns(), image.rows()));
  const Sizes sizes{search.min_diameter, search.max_diameter > 0 ? search.max_diameter : 0.6 * side};
  if (sizes.largest < sizes.smallest) return {};

  const bool by_edges = search.method == CraterMethod::edges;
  auto bowls = by_edges ? find_craters_by_edges(whole, *sun, sizes.smallest, sizes.largest)
                        : bowls_in(whole, *sun, search, sizes);
  std::erase_if(bowls, [&](const VerifiedBowl& bowl) {
    const CraterCandidate& c = bowl.circle;
    return c.score < search.min_confidence || c.diameter < 0.9 * sizes.smallest ||
           c.diameter > sizes.largest || whole.known_fraction(c.x, c.y, c.diameter) < kMinKnown;
  });
  RepetitionRules rules;
  if (by_edges || !search.verify) rules.sure = kNeverSure;
  std::vector<Detection> found;
  // Removed last: smaller candidates take part in the suppression.
  for (const VerifiedBowl& bowl : suppress_repetitions(std::move(bowls), rules))
    if (bowl.circle.diameter >= sizes.smallest) found.push_back(detection_of(bowl, search.type));
  return found;
}

}  // namespace waymark::pipeline
