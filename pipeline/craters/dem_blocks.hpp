// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/observation.hpp"
#include "geo/dem_source.hpp"
namespace waymark::pipeline {

/// Limits of a crater search in a DEM of any size.
struct DemSurvey {
  TypeId type = 0;            ///< id of the landmark type `crater`
  double min_diameter = 9;    ///< cells
  double max_diameter = 400;  ///< cells, <= kMaxDemDiameter
  double min_confidence = 0.5;
};

inline constexpr std::int64_t kDemCore = 2048;   ///< cells; side of the squares into which a DEM is cut
inline constexpr std::int64_t kDemMargin = 384;  ///< cells read beyond each side
inline constexpr double kMaxDemDiameter = 400;   ///< cells, diameter

/// Returns the craters whose centres lie in a window of the DEM, in map coordinates, sorted by row, then
/// column. Features: radius, depth, axes, orientation; z is the height of the rim. The DEM is cut into the
/// same squares for any window, so tiles of any size give the same craters. Degrees are converted to metres
/// at the latitude of each square.
std::vector<Observation> survey_craters(const DemSource& dem, const Window& window, const DemSurvey& survey);

}  // namespace waymark::pipeline
