// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "core/observation.hpp"
#include "geo/crs.hpp"
#include "geo/terrain.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/association/observed_object.hpp"
#include "pipeline/fusion/projection/image_view.hpp"
namespace waymark::pipeline {

struct AlignmentRules {
  AssociationRules association;
  int rounds = 4;     ///< of data association with the gates left by the previous round
  int solutions = 4;  ///< reweighted solutions per round
  /// Upper limit of the independent pairs of an image, since neighbouring pairs share errors of the DEM.
  double independent_pairs = 100;
  int max_images = 250;               ///< more are not aligned: 6 n unknowns are solved densely
  double added_position_sd = 0;       ///< metres: of the centres, beyond what the poses state
  double added_rotation_sd = 0;       ///< radians: of the rotations, beyond what the poses state
  bool added_where_unstated = false;  ///< only to centres and to rotations whose covariance is 0
};

struct Alignment {
  std::vector<Observation> observations;  ///< in input order, positions and covariances corrected
  std::vector<ImageView> images;          ///< in input order, poses and their covariances corrected
  std::vector<double> shifts;             ///< per image: mean shift of its observations, metres
  int pairs = 0;                          ///< pairs of observations used in the last round
  bool too_many = false;                  ///< not aligned: more than `max_images`
};

/// Estimates corrections of image poses from shared landmarks: a small bundle adjustment whose tie points are
/// landmarks.
/// - All observations of an image share its pose error. Treated as independent, they widen every gate and
///   neighbours merge.
/// - Observations of two images tie them if each is the only candidate of the other.
/// - The six corrections of each pose are solved by weighted least squares, with the pose covariances as
///   prior and Cauchy weights against wrong pairs.
/// - ImageView::dem_constraint enters as a further observation, divided by the number of images that share
///   that ground.
/// - The uncertainty common to all images goes to ImageView::common_covariance; the rest stays in the
///   covariances of observations.
/// Images without pose, or with a pose of zero covariance, do not move. Deterministic. `observations` in any
/// order; `terrain` gives slopes.
Alignment align_images(std::vector<Observation> observations, std::vector<ImageView> images,
                       const Terrain& terrain, const TypeRegistry& types, const Crs& crs,
                       const AlignmentRules& rules = {});

}  // namespace waymark::pipeline
