// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>
#include "geo/image_source.hpp"
#include "pipeline/craters/crater_features.hpp"
#include "pipeline/craters/crater_model.hpp"
#include "pipeline/craters/shaded_scene.hpp"
namespace waymark::pipeline {

/// Applies random radiometric changes: blur, uneven brightness, noise, stripes, flat-fielding, equalisation
/// or stretch, JPEG compression, resampling. Positions do not change. Deterministic for a seed.
void augment_image(Pixels& image, std::uint64_t seed);

/// Training example of the convolutional networks.
struct WidePatchExample {
  WidePatch wide;
  bool crater = false;
  float along = 0, across = 0, log_size = 0;  ///< as in CraterPrediction; for craters only
};

/// Returns labelled bowl candidates of a scene after augment_image, with the sun direction known to 0.1
/// radians only.
/// - Crater: intersection over union of at least 0.5 with a crater of clarity 0.25 or more.
/// - Background: intersection over union below 0.3 with all, or with a crater that is almost erased.
std::vector<WidePatchExample> make_patch_examples(const LabelledScene& scene, std::uint64_t seed);

/// Trains one convolutional network. Examples are mirrored along the light at random; half of them get
/// tones bent, clipped, tilted or noisier. Single-threaded.
ConvolutionNet train_patch_network(std::span<const WidePatchExample> examples, int rounds, std::uint64_t seed,
                                   const std::function<void(int round, double loss)>& progress = {});

}  // namespace waymark::pipeline
