// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>
#include "pipeline/craters/crater_features.hpp"
#include "pipeline/craters/crater_model.hpp"
#include "pipeline/craters/shaded_scene.hpp"
namespace waymark {

/// One look at a candidate, to learn from.
struct LookExample {
  CraterLook look;
  bool crater = false;
  float along = 0, across = 0, log_size = 0;  ///< as in CraterVerdict; of craters only
};

/// The bowls found in a scene once it is published otherwise (publish_otherwise), the sun known to 0.1
/// radians only. A crater where they overlap by half one of clarity 0.25 or more; nothing where they touch
/// none by 0.3, or one that is all but gone.
std::vector<LookExample> looks_of(const KnownScene& scene, std::uint64_t seed);

/// The convolutional part of a crater model. Each example is seen as it is or in a mirror along the light,
/// half of them with tones bent, clipped, tilted or noisier than they were. One thread.
ConvolutionNet train_looks(std::span<const LookExample> examples, int rounds, std::uint64_t seed,
                           const std::function<void(int round, double loss)>& progress = {});

}  // namespace waymark
