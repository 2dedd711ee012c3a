// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "localization/global/horizon_place.hpp"
namespace waymark {

/// The horizons of all places of a grid, found once for a map. 5 s of one core for 110 km x 80 km, 1 km
/// apart; memory 1.5 kB per place, and 6 bytes per cell of the DEM.
class SkylineIndex {
 public:
  SkylineIndex(std::vector<SkylineSummit> summits, const GroundHeight& ground, const SkylineOptions& options);

  /// As find_by_skyline. `heading` of a compass, with its standard deviation, instead of that of the options.
  SkylineAnswer find(std::span<const HorizonTop> tops, std::optional<double> heading = {}) const;
  std::size_t places() const { return places_.size(); }

 private:
  friend class SkylineSearch;
  std::vector<SkylineSummit> summits_;
  SkylineOptions options_;
  TerrainGrid terrain_;
  std::vector<HorizonPlace> places_;
};

}  // namespace waymark
