// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/observation.hpp"
#include "geo/dem_source.hpp"
namespace waymark {

/// What to look for in a DEM of any size.
struct DemSurvey {
  TypeId type = 0;            ///< id of the landmark type `crater`
  double min_diameter = 9;    ///< cells
  double max_diameter = 400;  ///< cells, <= kDemLargest
  double min_confidence = 0.5;
};

inline constexpr std::int64_t kDemCore = 2048;   ///< cells; side of the squares a DEM is searched in
inline constexpr std::int64_t kDemMargin = 384;  ///< seen beyond each side
inline constexpr double kDemLargest = 400;       ///< cells, diameter

/// Craters whose centres lie in a window of the DEM, placed on the map: features radius, depth, axes,
/// orientation, the height of the rim as z. The DEM is cut into the same squares whatever the window, so
/// tiles of any size give the same craters. Degrees are taken as metres at each square's own latitude. Sorted
/// by row, then column.
std::vector<Observation> survey_craters(const DemSource& dem, const Window& window, const DemSurvey& survey);

}  // namespace waymark
