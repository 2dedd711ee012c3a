// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "workflows/mapping/loaded_map.hpp"
namespace waymark::workflows {

/// Numbers of landmarks of a merge.
struct JoinCounts {
  std::int64_t fused = 0;      ///< of both maps, from different observations
  std::int64_t identical = 0;  ///< of both maps, the observations of one contain those of the other
};

/// Merges map `b` into `a`, both of one CRS.
/// - Landmarks of both maps are paired by uid, if they share an observation or their position, then by the
///   association of the pipeline. Landmarks that identify themselves are paired by uid alone.
/// - Pairs are fused by fuse_landmarks(). If the observations of one contain those of the other, the former
///   stays as it is; if they are the same, that of the map with more runs.
/// - An image, a layer or a landmark of `b` gets a suffix if its name is taken by another one of `a`.
/// - Observations, rejected ones too, rows of layers and runs that both maps have are kept once.
/// Throws Error{input} for types that differ (merged_types.hpp).
LoadedMap join_maps(LoadedMap a, LoadedMap b, JoinCounts& counts);

}  // namespace waymark::workflows
