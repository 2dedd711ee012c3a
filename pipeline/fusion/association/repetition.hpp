// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>
#include "core/observation.hpp"
#include "geo/crs.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/association/observed_object.hpp"
#include "pipeline/fusion/projection/image_view.hpp"
namespace waymark::pipeline {

struct RepetitionRules {
  AssociationRules association = {};
  double min_confidence = 0.5;  ///< of an object that other images should show, too
  double min_diameter = 6;      ///< of its image in both images, pixels
  /// Standard deviation of a position: these fractions of the ground sample distance and of the radius. Gates
  /// do not follow the covariances of the observations, which are what is tested.
  double sd_of_gsd = 0.35, sd_of_radius = 0.06;
  /// Objects compared at most; with more, every n-th one.
  std::size_t max_objects = 20000;
};

/// Objects of one image that another should show.
struct ImagePair {
  std::uint32_t from = 0, to = 0;  ///< indices of the images
  std::size_t expected = 0, matched = 0;
};

/// How many objects of one image are found again in others: a check of poses, lenses and heights that needs
/// no truth.
struct Repetition {
  std::size_t expected = 0;           ///< views of an object in which it should be seen again
  double raw = 0;                     ///< fraction of these with an object of similar size inside the gates
  double chance = 0;                  ///< the same for positions beside the object: matches by chance
  std::vector<ImagePair> pairs = {};  ///< the views by image and other image, in the order of these
  /// Returns the fraction found again, without matches by chance; 0 if nothing is expected.
  double found() const { return chance < 1 ? (raw - chance) / (1 - chance) : 0; }
};

/// Compares each object with the other images of a similar sun that cover it, occluded or not.
/// - With right geometry .8 to .95 are found again; with wrong poses, lenses or heights next to none.
/// - Errors that all images share (a shifted DEM, a common offset of the poses) remain unseen.
/// Objects without a body size are left out. O(n i) for n objects and i images.
Repetition measure_repetition(std::span<const Observation> observations, std::span<const ImageView> images,
                              const TypeRegistry& types, const Crs& crs, const RepetitionRules& rules = {});

}  // namespace waymark::pipeline
