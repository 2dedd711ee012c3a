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
  std::string aoi = {};           ///< polygons: landmarks outside are left out of the result; empty: none are
  bool changes = false;           ///< find what changed from the first to the second map, two only
  double max_move = 5;            ///< m; what moved farther is gone and new
};

/// Result of a merge: numbers of landmarks.
struct MergeResult {
  std::int64_t landmarks = 0;    ///< of the merged map
  std::int64_t fused = 0;        ///< found in several maps, from different observations
  std::int64_t identical = 0;    ///< found in several maps, from the same observations
  std::int64_t disagreeing = 0;  ///< that identify themselves, in other positions in the maps
  /// Changes from the first to the second map, if they were requested (find_changes).
  std::int64_t gone = 0, appeared = 0, moved = 0, unchanged = 0, not_covered = 0;
};

/// Merges maps by join_maps() into one, which does not depend on their order.
/// - Maps are taken in the order of their file names, of equal names in that of their hashes. The record of
///   the run has the time of the latest run of the maps. So equal maps give equal bytes.
/// - Elevation tiles are left out, with a warning.
/// - Of landmarks that identify themselves and disagree in position that of the later map counts, with a
///   warning: of the second map if changes are requested, else of the map with the latest run.
/// - The maps are merged whole before the area of interest is cut out, so that its border changes no
/// landmark.
///   Counts but `landmarks` are of the whole maps.
/// - Requested changes are the layer `change` of the result. The order of the maps matters to them.
/// - Throws Error{usage} for fewer than two maps, maps of different CRSs, or a result that is one of them.
/// - Throws Error{usage} for changes of more than two maps, or a `max_move` outside [0, 1e6].
/// - Throws Error{input} for maps with errors or types that differ.
MergeResult merge_maps(const MergeRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
