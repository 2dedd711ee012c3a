// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/dem_source.hpp"
namespace waymark::planning {

/// Direction of a horizon over a DEM.
struct HorizonRay {
  double azimuth = 0;             ///< degrees clockwise from grid north
  double reach = 1000;            ///< metres
  double cell_x = 1, cell_y = 1;  ///< metres
  double body_radius = 0;         ///< metres; 0: flat
};

/// Returns the cells beyond a window that its horizons read: to the side of the azimuth only.
struct HorizonMargin {
  std::int64_t west = 0, east = 0, north = 0, south = 0;
};
HorizonMargin horizon_margin(const HorizonRay& ray);

/// Returns the elevation of the horizon in one azimuth for each cell of `inner`, degrees; NaN for cells
/// without height. The ray is sampled where it crosses columns or rows, whichever are crossed more often,
/// with heights interpolated between the two cells there. Unknown terrain does not rise.
/// - `heights` covers `inner` with the margin; `inner` is relative to it.
/// - Stops where not even the highest cell could rise above the horizon found; the result is that of
///   sun_horizon_directly().
Grid<float> sun_horizon(const HeightWindow& heights, const Window& inner, const HorizonRay& ray);

/// Computes the same along the whole reach of every ray.
Grid<float> sun_horizon_directly(const HeightWindow& heights, const Window& inner, const HorizonRay& ray);

}  // namespace waymark::planning
