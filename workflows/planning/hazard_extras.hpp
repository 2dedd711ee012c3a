// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "planning/hazard_map.hpp"
#include "planning/landing_safety.hpp"
#include "planning/sun_horizon.hpp"
#include "workflows/planning/hazards.hpp"
namespace waymark::workflows {

/// Bands of a hazard map that are made on request, after the class.
struct HazardExtras {
  std::optional<Eigen::Matrix2d> landing = {};  ///< covariance of the touchdown in cells
  std::optional<planning::HorizonRay> ray = {};
  double sun_elevation = 0;  ///< degrees

  std::vector<planning::BandName> bands() const;
};

/// Throws Error{usage} for ellipses and suns that are none, and for those that need over 4000 cells beside a
/// tile.
HazardExtras parse_hazard_extras(const HazardMapRequest& request, const GridGeometry& grid);

/// Returns all bands of a window. A cell does not depend on the window.
std::vector<Grid<float>> compute_with_extras(const planning::HazardMap& hazards, const DemSource& dem,
                                             const Window& window, const HazardExtras& extras);

}  // namespace waymark::workflows
