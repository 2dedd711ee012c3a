// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/observation.hpp"
#include "geo/dem_source.hpp"
#include "pipeline/craters/find_craters.hpp"
namespace waymark::pipeline {

inline constexpr std::int64_t kDemCore = 2048;   ///< cells; side of the squares into which a DEM is cut
inline constexpr std::int64_t kDemMargin = 384;  ///< cells read beyond each side
inline constexpr double kMaxDemDiameter = 400;   ///< cells, diameter

/// Crater search in a DEM of any size.
struct DemSurvey {
  TypeId type = 0;  ///< id of the landmark type `crater`
  /// Diameters at most kMaxDemDiameter; the sizes of the cells are those of the DEM.
  DemCraterSearch search = {.max_diameter = kMaxDemDiameter};
};

/// Returns the craters whose centres lie in a window of the DEM, in map coordinates, sorted by row, then
/// column. Features: radius, depth, axes, orientation; z is the height of the rim. The DEM is cut into the
/// same squares for any window, so tiles of any size give the same craters. Degrees are converted to metres
/// at the latitude of each square.
std::vector<Observation> survey_craters(const DemSource& dem, const Window& window, const DemSurvey& survey);

}  // namespace waymark::pipeline
