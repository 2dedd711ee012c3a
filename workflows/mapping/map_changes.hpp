// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>
#include "geodb/shape_layer.hpp"
#include "workflows/mapping/loaded_map.hpp"
namespace waymark::workflows {

enum class ChangeKind { gone, appeared, moved };

/// Difference between an earlier and a later map of one site.
struct MapChange {
  ChangeKind kind = ChangeKind::gone;
  std::optional<std::size_t> earlier, later;  ///< landmarks, by their indices in the maps
  double distance = 0;                        ///< metres from the earlier to the later position
};

struct MapChanges {
  std::vector<MapChange> changes;  ///< in the order of the earlier map, then of the later one
  std::int64_t unchanged = 0;      ///< landmarks that both maps have in one position
  std::int64_t not_covered = 0;    ///< landmarks of one map where the other one shows nothing
};

/// Finds what changed between two maps with the same types (adopt_types) and one CRS. `partners` has for each
/// landmark of the later map that of the earlier map, as JoinRecord.
/// - A landmark of one map alone is a change only where the other map covers it. Images cover their
///   footprints, if they are at least nearly as sharp (1.1) as the coarsest image that shows the landmark;
///   a map without footprints covers the convex hull of its landmarks.
/// - A landmark of the earlier map alone moved, if the later map alone has one of its type and of similar
///   size within `max_move` metres; one of both is covered. The nearest are paired first (association_cost).
/// - Partners that disagree in position (same_place) moved, whatever their distance.
MapChanges find_changes(const LoadedMap& earlier, const LoadedMap& later,
                        const std::vector<std::optional<std::size_t>>& partners, double max_move);

/// Returns whether two landmarks of one type agree in position, size and direction within their covariances.
bool same_place(const Landmark& a, const Landmark& b, const TypeRegistry& types, const Crs& crs);

/// Returns the changes as the layer `change` of points: where a landmark was, if it is gone, else where it
/// is. `uid_of` names the landmark of a change in the merged map.
geodb::ShapeLayer change_layer(const MapChanges& changes, const LoadedMap& earlier, const LoadedMap& later,
                               const std::function<std::string(const MapChange&)>& uid_of);

}  // namespace waymark::workflows
