// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>
#include "pipeline/craters/crater_training.hpp"
#include "pipeline/craters/relief_verifier.hpp"
namespace waymark::pipeline {

/// Returns the circles that the built-in model found and corrected in a scene, with labels, each twice, once
/// mirrored. Most scenes are degraded as published images are (augment_image); the sun is known to 0.06
/// radians.
/// - Crater: intersection over union of at least 0.5 with a clear crater.
/// - Background: below 0.3 with all. All others are left out.
std::vector<CraterExample> make_relief_examples(LabelledScene scene, std::uint64_t seed);

/// Trains `networks` networks that differ in their seed, in parallel. `progress` receives the network, the
/// epoch and its mean loss, from several threads. Throws std::logic_error if all examples are of one class.
ReliefVerifier train_relief_verifier(
    std::span<const CraterExample> examples, CraterTraining training, int networks,
    const std::function<void(int network, int round, double loss)>& progress);

}  // namespace waymark::pipeline
