// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "pipeline/engine/store/kept_results.hpp"
#include "pipeline/reconstruction/matching/image_features.hpp"
#include "pipeline/reconstruction/matching/match_images.hpp"
#include "workflows/callbacks.hpp"
#include "workflows/reconstruction/read_photos.hpp"
namespace waymark::workflows {

/// Features of pictures, in pixels of the files.
struct PhotoFeatures {
  std::vector<pipeline::ImageFeatures> features = {};
  std::vector<std::string> faults = {};        ///< by picture, why it is of no use; empty: none
  std::vector<std::string> fingerprints = {};  ///< by picture, of its bytes and settings; empty: not kept
};

/// Finds the features of all pictures; those above `max_pixels` are reduced for it. A picture that cannot be
/// read has a fault and no features. Progress: stage `read_folder`.
PhotoFeatures find_photo_features(const Photos& photos, double max_pixels, const pipeline::KeptResults& kept,
                                  const Callbacks& callbacks = {});

/// Returns what is matched: names, lenses, and positions in metres about the first one, which serve to choose
/// neighbours only.
std::vector<pipeline::ImageToMatch> images_to_match(const Photos& photos);

}  // namespace waymark::workflows
