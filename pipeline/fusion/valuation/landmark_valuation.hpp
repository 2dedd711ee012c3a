// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>
#include "core/landmark.hpp"
#include "geo/terrain.hpp"
#include "landmarks/existence_rules.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/valuation/image_coverage.hpp"
namespace waymark::pipeline {

/// Returns the probability that a landmark exists:
///   logit p = best + further_detection x sum of the others - missed_image x missed - prior_penalty.
/// `confidences` in (0, 1]; `missed` is the number of images that covered it without a detection.
double existence_probability(std::span<const double> confidences, int missed,
                             const ExistenceRules& rules = {});

/// Meaning of "the image covers L" and "at least the resolution of i_0" in eqs. 4 and 5.
enum class CoverRule {
  /// L lies completely inside the image and is not occluded; its ground sample distance is at most that of
  /// the coarsest image that detected L (i_0), with a tolerance of 10 %.
  sound,
  /// As in the paper: the footprint contains L's position, and area(i) <= area(i_0), the largest image that
  /// detected L.
  paper,
};

struct ValuationRules {
  CoverRule cover = CoverRule::sound;
  SpreadRule spread = SpreadRule::sound;
  CoverageRules coverage = {};
  std::optional<ExistenceRules> existence = {};  ///< absent: the rules of each type
};

/// Computes the quality of landmarks (Rossmann et al. 3.3): number of images that detected and that cover
/// each (eqs. 4-5), q_f per feature (eqs. 6-7) and the probability of existence.
/// - i_0 is chosen from the images that *detected* L. The paper expects L "in other images showing the same
///   region with the same or better resolution". An image that detected L covers it.
/// - A source without an ImageView (a DEM, a table) is a survey that detected L and could have.
/// - ImageView::common_covariance is added to the covariances.
/// - With SpreadRule::sound, errors that all images share are added to the features of landmarks of images
///   (common_errors.hpp) after q_f is computed.
/// `terrain` may be null. Positions in units of a CRS of `metres_per_unit`. `evidence` names landmarks by
/// uid.
void value_landmarks(std::span<Landmark> landmarks, std::span<const Observation> evidence,
                     std::span<const ImageView> images, const Terrain* terrain, const TypeRegistry& types,
                     double metres_per_unit, const ValuationRules& rules = {});

/// Removes landmarks less probable than `min_probability` of their type and rejects their evidence. Returns
/// their number.
std::int64_t remove_improbable(std::vector<Landmark>& landmarks, std::vector<Observation>& evidence,
                               const TypeRegistry& types);

}  // namespace waymark::pipeline
