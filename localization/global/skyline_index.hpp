// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "localization/global/horizon_viewpoint.hpp"
#include "localization/horizon_profile.hpp"
namespace waymark::localization {

/// Horizons at all positions of a grid, computed once for a map. 5 s of one core for 110 km x 80 km, 1 km
/// apart; 1.5 kB per position and 6 bytes per cell of the DEM.
class SkylineIndex {
 public:
  SkylineIndex(std::vector<SkylineSummit> summits, const TerrainHeight& ground,
               const SkylineOptions& options);

  /// Finds as find_by_skyline() does. `heading`: that of a compass, instead of the options'.
  SkylineAnswer find(std::span<const HorizonTop> tops, std::optional<double> heading = {}) const;
  /// Finds the pose by the whole horizon rather than its tops. Unknown elevations, parts of a turn and
  /// obstacles in front of the horizon are allowed for. Names no summits.
  SkylineAnswer find(const HorizonProfile& horizon, std::optional<double> heading = {}) const;
  std::size_t viewpoints() const { return viewpoints_.size(); }

 private:
  friend class SkylineSearch;
  std::vector<SkylineSummit> summits_;
  SkylineOptions options_;
  TerrainGrid terrain_;
  std::vector<HorizonViewpoint> viewpoints_;
};

}  // namespace waymark::localization
