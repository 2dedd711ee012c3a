// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/signature.hpp"

#include <algorithm>

namespace waymark::localization {

void merge_signature(const FeatureScales& scales, TypeId type, KnownFeatures& known,
                     const KnownFeatures& seen, double tolerance) {
  for (std::size_t i = 0; i < kMaxFeatures; ++i) {
    if (!seen.known(i)) continue;
    const double spread = scales.is_angle(type, i) ? scales.tolerance_sd(type, i, seen.value[i], tolerance)
                                                   : tolerance * seen.value[i];
    const double noise = std::max({seen.variance[i], spread * spread, 1e-12});
    if (!known.known(i)) {
      known.value[i] = seen.value[i];
      known.variance[i] = noise;
      continue;
    }
    const double before = std::max(known.variance[i], spread * spread / 4);
    const double weight = before / (before + noise);
    known.value[i] += weight * scales.difference(type, i, seen.value[i], known.value[i]);
    known.variance[i] = std::max((1 - weight) * before, spread * spread / 4);
  }
}

}  // namespace waymark::localization
