// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>

#include "pipeline/rocks/rock_evidence.hpp"
#include "pipeline/rocks/rock_network.hpp"
namespace waymark::pipeline {

RockPrediction predict_rock(const RockEvidence& evidence) {
  using namespace rock_network;
  static_assert(std::size(kMean) == kEvidenceCount);
  constexpr std::size_t units = std::size(kHidden) / (kEvidenceCount + 1);
  static_assert(std::size(kOut) == kOutputs * (units + 1));
  // Input by input, so that the sums of all units vectorise.
  float unit[units];
  std::copy_n(&kHidden[units * kEvidenceCount], units, unit);
  for (std::size_t i = 0; i < kEvidenceCount; ++i) {
    const float in = std::clamp((static_cast<float>(evidence[i]) - kMean[i]) / kSd[i], -6.0F, 6.0F);
    for (std::size_t h = 0; h < units; ++h) unit[h] += kHidden[units * i + h] * in;
  }
  float out[kOutputs];
  std::copy_n(&kOut[kOutputs * units], kOutputs, out);
  for (std::size_t h = 0; h < units; ++h) {
    const float value = std::tanh(unit[h]);
    for (std::size_t o = 0; o < kOutputs; ++o) out[o] += kOut[kOutputs * h + o] * value;
  }
  const auto sd = [&](std::size_t o) { return std::exp(std::clamp(static_cast<double>(out[o]), -4.0, 1.0)); };
  const auto factor = [&](std::size_t o) { return std::clamp(static_cast<double>(out[o]), -1.5, 1.5); };
  return {.confidence = 1 / (1 + std::exp(-static_cast<double>(out[0]))),
          .log_radius = factor(1),
          .log_reach = factor(2),
          .along = factor(3),
          .log_radius_sd = sd(4),
          .log_reach_sd = sd(5),
          .along_sd = sd(6),
          .across_sd = sd(7)};
}

}  // namespace waymark::pipeline
