// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "core/observation.hpp"
#include "geo/crs.hpp"
#include "geo/terrain.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/image_view.hpp"
#include "pipeline/fusion/sighting.hpp"
namespace waymark {

struct AlignmentRules {
  IdentityRules identity;
  int rounds = 4;     ///< of pairing anew with the gates the last round left
  int solutions = 4;  ///< reweighted solutions per round
  /// Neighbouring pairs share errors of the DEM: more pairs of an image tell no more than so many.
  double independent_pairs = 100;
  int most_images = 250;  ///< more are left as they are: 6 n unknowns are solved densely
};

struct Alignment {
  std::vector<Observation> observations;  ///< in the order given, places and covariances corrected
  std::vector<ImageView> images;          ///< in the order given, poses and their covariances corrected
  std::vector<double> moved;              ///< per image: how far its ground moved at its middle, metres
  int pairs = 0;                          ///< pairs of observations used in the last round
  bool too_many = false;                  ///< nothing was done: more than `most_images`
};

/// Takes the errors of poses out of the way of merging. All observations of an image share the error of its
/// pose, so they are off together; treated as independent they make every gate as wide as the pose is
/// uncertain, and neighbours merge. Here observations of different images that could only be each other
/// (no other candidate in either image) tie the images together: the six corrections of every pose are
/// solved for by weighted least squares with the poses' own covariances as prior and Cauchy weights against
/// wrong pairs (a small bundle adjustment whose points are landmarks); what a comparison with the DEM told of
/// a pose (ImageView::on_ground) goes in too, each by its share of what all images on that ground know. What
/// remains uncertain is split: the part common to all images goes to ImageView::common and is out of the
/// gates, the rest stays in the observations' covariances. Images without pose or whose pose is told to be
/// exact do not move. Deterministic. `observations` in any order; `terrain` gives the slope of the ground.
Alignment align_images(std::vector<Observation> observations, std::vector<ImageView> images,
                       const Terrain& terrain, const TypeRegistry& types, const Crs& crs,
                       const AlignmentRules& rules = {});

}  // namespace waymark
