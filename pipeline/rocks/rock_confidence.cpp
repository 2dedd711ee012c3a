// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <iterator>

#include "pipeline/rocks/rock_confidence_weights.hpp"
#include "pipeline/rocks/rock_evidence.hpp"
namespace waymark {

double rock_confidence(const RockEvidence& evidence) {
  using namespace rock_network;
  static_assert(std::size(kMean) == kEvidenceCount);
  constexpr std::size_t units = std::size(kOut) - 1;
  static_assert(std::size(rock_network::kHidden) == units * (kEvidenceCount + 1));
  double in[kEvidenceCount];
  for (std::size_t i = 0; i < kEvidenceCount; ++i)
    in[i] = (evidence[i] - static_cast<double>(kMean[i])) / static_cast<double>(kSd[i]);
  double sum = static_cast<double>(kOut[units]);
  for (std::size_t h = 0; h < units; ++h) {
    const float* row = &rock_network::kHidden[h * (kEvidenceCount + 1)];
    double unit = static_cast<double>(row[kEvidenceCount]);
    for (std::size_t i = 0; i < kEvidenceCount; ++i) unit += static_cast<double>(row[i]) * in[i];
    sum += static_cast<double>(kOut[h]) * std::tanh(unit);
  }
  return 1 / (1 + std::exp(-sum));
}

}  // namespace waymark
