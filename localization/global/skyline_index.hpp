// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <vector>
#include "localization/global/skyline.hpp"
namespace waymark {

/// Which summits stand on the horizon of each place of a grid, found once for a map by lines of sight over
/// the DEM. A few seconds for 100 km x 100 km, 1 km apart, and 1000 summits; memory 200 bytes per place.
class SkylineIndex {
 public:
  SkylineIndex(std::vector<SkylineSummit> summits, GroundHeight ground, const SkylineOptions& options);

  /// As find_by_skyline. `heading` of a compass, with its standard deviation, instead of that of the options.
  SkylineAnswer find(std::span<const HorizonTop> tops, std::optional<double> heading = {}) const;
  std::size_t places() const { return places_.size(); }

 private:
  friend class SkylineSearch;
  struct Place {
    Eigen::Vector2d at;
    double lowest, highest;  // ground within half a step
    std::vector<std::uint32_t> summits;
  };
  std::optional<Place> look_round(const Eigen::Vector2d& at) const;

  std::vector<SkylineSummit> summits_;
  GroundHeight ground_;
  SkylineOptions options_;
  Eigen::AlignedBox2d bounds_;
  std::vector<Place> places_;
};

}  // namespace waymark
