// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>
#include "pipeline/craters/crater_model.hpp"
#include "pipeline/craters/shaded_scene.hpp"
namespace waymark::pipeline {

/// Known crater with the largest intersection over union with a circle; null and 0 if none intersects.
struct MatchedCrater {
  const LabelledCrater* crater = nullptr;
  double overlap = 0;
};
MatchedCrater match_crater(const LabelledScene& scene, const CraterCandidate& circle);

/// Training example of the dense network.
struct CraterExample {
  CraterFeatures features{};
  bool crater = false;
  float along = 0, across = 0, log_size = 0;  ///< as in CraterPrediction; for craters only
};

/// Returns the bowl candidates of a scene with labels, each twice, once mirrored.
/// - Crater: intersection over union of at least 0.5 with a clear crater.
/// - Background: no intersection.
/// - All others, and those on unclear craters, are left out.
std::vector<CraterExample> make_crater_examples(const LabelledScene& scene, std::uint64_t seed);

struct CraterTraining {
  int rounds = 4;  ///< epochs
  std::vector<int> hidden{32, 16};
  double decay = 0.03;  ///< of weights, per step and unit of learning rate (Loshchilov & Hutter 2019)
  std::uint64_t seed = 1;
};

/// Minimises cross entropy and, for craters, squared error of position and size with Adam (Kingma & Ba
/// 2015). Single-threaded; weights are reproducible but for the last bits of exp. `progress` receives the
/// epoch and its mean loss.
CraterModel train_crater_model(std::span<const CraterExample> examples, const CraterTraining& training,
                               const std::function<void(int round, double loss)>& progress = {});

}  // namespace waymark::pipeline
