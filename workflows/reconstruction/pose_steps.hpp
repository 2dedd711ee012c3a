// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/engine/codec.hpp"
#include "pipeline/engine/store/kept_results.hpp"
#include "workflows/reconstruction/photo_features.hpp"
#include "workflows/reconstruction/pose_photos.hpp"
namespace waymark::workflows {

/// Steps of pose_photos() after the features: each depends on the one before.
struct PoseSteps {
  pipeline::KeptStep matches, solved, poses;
};

/// Returns the steps with what determines their results: features, lenses, references. Nothing is read where
/// nothing is kept.
PoseSteps pose_steps(const PosePhotosRequest& request, const Photos& photos, const PhotoFeatures& found,
                     const std::vector<pipeline::ImageToMatch>& images, const pipeline::KeptResults& kept);

}  // namespace waymark::workflows

namespace waymark::pipeline {

template <>
struct Codec<workflows::PosedPhotos> {
  static std::string encode(const workflows::PosedPhotos& value);
  static workflows::PosedPhotos decode(std::string_view bytes);
};

}  // namespace waymark::pipeline
