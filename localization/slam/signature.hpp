// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/identification/feature_distance.hpp"
namespace waymark {

/// The signature of a landmark (section 4.4): its features with the variance of each, merged as they are seen
/// again. A feature seen for the first time is taken over; afterwards the two are weighed by their variances,
/// which are not let below (tolerance * value)^2 / 4: a thing does not look the same from all sides.
/// Features not seen stay as they are.
void merge_signature(const FeatureScales& scales, TypeId type, KnownFeatures& known,
                     const KnownFeatures& seen, double tolerance);

}  // namespace waymark
