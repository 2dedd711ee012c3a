// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

struct MergeRequest {
  std::vector<std::string> maps;  ///< two or more, of one CRS
  std::string result;             ///< .gpkg, none of the maps
};

/// Result of a merge: numbers of landmarks.
struct MergeResult {
  std::int64_t landmarks = 0;  ///< of the merged map
  std::int64_t fused = 0;      ///< found in several maps, from different observations
  std::int64_t identical = 0;  ///< found in several maps, from the same observations
};

/// Merges maps by join_maps() into one, which does not depend on their order.
/// - Maps are taken in the order of their file names, of equal names in that of their hashes. The record of
///   the run has the time of the latest run of the maps. So equal maps give equal bytes.
/// - Elevation tiles are left out, with a warning.
/// - Throws Error{usage} for fewer than two maps, maps of different CRSs, or a result that is one of the
///   maps; Error{input} for maps with errors or types that differ.
MergeResult merge_maps(const MergeRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
