// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>
#include "pipeline/fusion/association/repetition.hpp"
namespace waymark::pipeline {

struct OutlyingImageRules {
  std::size_t min_expected = 20;  ///< views shared with the other images; with fewer there is no verdict
  double wrong = 0.35;            ///< found again at most between an outlying image and the others
  double sound = 0.6;             ///< found again at least among the others
};

/// Image whose objects the others do not show where it has them.
struct OutlyingImage {
  std::size_t image = 0;     ///< index in the order of the images compared
  std::size_t expected = 0;  ///< views of an object that it shares with the images that fit each other
  double raw = 0;            ///< fraction of these found again
};

/// Images whose pose is wrong alone, the worst first.
struct OutlyingImages {
  std::vector<OutlyingImage> images;
  double rest = 0;  ///< fraction of the views among all others that are found again
};

/// Removes the image that fits the others least, as long as it hardly fits them at all. Empty if the others
/// do not fit each other then, or if a third of the images or more would go. O(n p) for n images and p pairs.
OutlyingImages find_outlying_images(const Repetition& seen, const OutlyingImageRules& rules = {});

}  // namespace waymark::pipeline
