// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "landmarks/landmark_type.hpp"
namespace waymark::localization {

/// Landmark types that the detectors of this folder find; absent: not in the map, so that sightings have no
/// type.
struct DetectedTypes {
  std::optional<TypeId> tree, rock, mountain_top;
};

/// Returns the types of the detectors among those of a map.
DetectedTypes detected_types(const TypeRegistry& types);

}  // namespace waymark::localization
