// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>
#include "workflows/mapping/loaded_map.hpp"
namespace waymark::workflows {

/// What a merge did: numbers of landmarks of all maps, and the pairs of the last two.
struct JoinRecord {
  std::int64_t fused = 0;      ///< of both maps, from different observations
  std::int64_t identical = 0;  ///< of both maps, the observations of one contain those of the other
  std::int64_t moved = 0;      ///< that identify themselves, in another position in each map
  std::vector<std::optional<std::size_t>> partners;  ///< per landmark of `b`: that of `a`
  std::vector<std::size_t> places;                   ///< per landmark of `b`: that of the merged map
};

/// Merges map `b` into `a`, both of one CRS. The landmarks of `a` keep their indices.
/// - Landmarks of both maps are paired by uid, if they share an observation or their position, then by the
///   association of the pipeline. Landmarks that identify themselves are paired by uid alone.
/// - Pairs are fused by fuse_landmarks(). If the observations of one contain those of the other, the former
///   stays as it is; if they are the same, that of the map with more runs.
/// - Of a landmark that identifies itself and moved (same_place) the later position counts, with the features
///   and counts of that map; the other one's observations become rejected.
/// - An image, a layer or a landmark of `b` gets a suffix if its name is taken by another one of `a`.
/// - Observations, rejected ones too, rows of layers and runs that both maps have are kept once.
/// Throws Error{input} for types that differ (merged_types.hpp).
LoadedMap join_maps(LoadedMap a, LoadedMap b, bool b_is_later, JoinRecord& record);

}  // namespace waymark::workflows
