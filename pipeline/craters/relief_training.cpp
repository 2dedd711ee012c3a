// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/relief_training.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/random.hpp"
#include "pipeline/craters/bowl_candidates.hpp"
#include "pipeline/craters/bowl_verification.hpp"
#include "pipeline/craters/patch_network_training.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kMinCommon = 0.5, kMaxBackground = 0.3;  // intersection over union
constexpr double kMinClear = 0.4;                         // clarity
constexpr double kMinDiameter = 12;                       // pixels; smaller craters of a DEM are smooth

}  // namespace

std::vector<CraterExample> make_relief_examples(LabelledScene scene, std::uint64_t seed) {
  Random random(seed, "examples of measured relief");
  if (random.bernoulli(0.7)) augment_image(scene.image, seed);
  const Radians sun{scene.sun_angle.value + random.normal(0, 0.06)};
  const FilledImage whole = fill_holes(scene.image);
  const double side = double(std::min(scene.image.columns(), scene.image.rows()));
  const auto candidates = suppress_overlaps(
      bowl_candidates(whole.pixels,
                      {.sun_angle = sun,
                       .limits = {.min_diameter = 11, .max_diameter = 0.6 * side, .min_correlation = 0.5}}),
      0.5);
  const PatchSource patches(whole.pixels, sun);
  const double cosine = std::cos(sun.value), sine = std::sin(sun.value);
  std::vector<CraterExample> examples;
  for (const VerifiedBowl& bowl : verify_bowls(whole, sun, candidates, {&built_in_crater_model(), nullptr})) {
    CraterCandidate c = bowl.corrected;
    if (c.diameter < kMinDiameter) continue;
    if (random.bernoulli(0.5)) {
      c.x += random.normal(0, 0.02) * c.diameter, c.y += random.normal(0, 0.02) * c.diameter;
      c.diameter *= std::exp(random.normal(0, 0.03));
    }
    const auto [best, common] = match_crater(scene, c);
    const bool crater = common >= kMinCommon && best->clarity >= kMinClear;
    if (!crater && common > kMaxBackground) continue;
    const double dx = crater ? (best->x - c.x) / c.diameter : 0,
                 dy = crater ? (best->y - c.y) / c.diameter : 0;
    const auto along = static_cast<float>(dx * cosine + dy * sine),
               across = static_cast<float>(dy * cosine - dx * sine),
               log_size = static_cast<float>(crater ? std::log(best->diameter / c.diameter) : 0);
    for (const bool mirrored : {false, true})
      examples.push_back(
          {patches.features(c, c.score, mirrored), crater, along, mirrored ? -across : across, log_size});
  }
  return examples;
}

ReliefVerifier train_relief_verifier(std::span<const CraterExample> examples, CraterTraining training,
                                     int networks, const std::function<void(int, int, double)>& progress) {
  const auto craters = std::ranges::count_if(examples, &CraterExample::crater);
  if (craters == 0 || craters == std::ssize(examples))
    throw std::logic_error("a verifier needs examples of craters and of background");
  ReliefVerifier verifier;
  verifier.prior = double(craters) / double(examples.size());
  verifier.networks.resize(static_cast<std::size_t>(networks));
  tbb::parallel_for(0, networks, [&](int index) {
    CraterTraining own = training;
    own.seed += static_cast<std::uint64_t>(index);
    verifier.networks[static_cast<std::size_t>(index)] =
        train_crater_model(examples, own, [&](int round, double loss) {
          if (progress) progress(index, round, loss);
        }).layers;
  });
  return verifier;
}

}  // namespace waymark::pipeline
