// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>
#include "pipeline/craters/crater_model.hpp"
#include "pipeline/craters/shaded_scene.hpp"
namespace waymark {

/// The known crater that a circle covers best, and their common area over the area they cover together;
/// null and 0 where none is met.
struct CoveredCrater {
  const KnownCrater* crater = nullptr;
  double overlap = 0;
};
CoveredCrater covered_crater(const KnownScene& scene, const CraterCandidate& circle);

/// One thing to learn.
struct CraterExample {
  CraterFeatures features{};
  bool crater = false;
  float along = 0, across = 0, log_size = 0;  ///< as in CraterVerdict; of craters only
};

/// The bowls found in a scene, with what they are: a crater where they overlap a clear one by half, nothing
/// where they touch none; those in between, and those on unclear craters, are left out. Each twice, once
/// mirrored.
std::vector<CraterExample> examples_of(const KnownScene& scene, std::uint64_t seed);

struct CraterTraining {
  int rounds = 4;  ///< times through the examples
  std::vector<int> hidden{32, 16};
  double decay = 0.03;  ///< of weights, per step and unit of learning rate (Loshchilov & Hutter 2019)
  std::uint64_t seed = 1;
};

/// Adam (Kingma & Ba 2015) over cross entropy and, for craters, squared error of place and size. One thread,
/// the same weights everywhere but for the last bits of exp. `progress` gets the round and its mean loss.
CraterModel train_crater_model(std::span<const CraterExample> examples, const CraterTraining& training,
                               const std::function<void(int round, double loss)>& progress = {});

}  // namespace waymark
