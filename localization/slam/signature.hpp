// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/identification/feature_distance.hpp"
namespace waymark::localization {

/// Merges a sighting into the signature of a landmark (section 4.4), its features with their variances. A
/// feature seen first is taken over; later ones are averaged by their variances, limited below to
/// (tolerance * value)^2 / 4 because an object looks different from each side. Unseen features stay as they
/// are.
void merge_signature(const FeatureScales& scales, TypeId type, KnownFeatures& known,
                     const KnownFeatures& seen, double tolerance);

}  // namespace waymark::localization
