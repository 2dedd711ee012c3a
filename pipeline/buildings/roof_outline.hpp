// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>
#include "pipeline/buildings/roof_regions.hpp"
namespace waymark::pipeline {

/// Ring along cell edges; metres in the axes of the survey. The first vertex is not repeated.
using RoofRing = std::vector<Eigen::Vector2d>;

/// Ground that a roof covers, on square cells.
struct RoofOutline {
  RoofRing outer = {};                  ///< counter-clockwise
  std::vector<RoofRing> holes = {};     ///< courtyards, clockwise
  double cell = 0;                      ///< side of the cells, m
  double area = 0;                      ///< without the holes, m2
  double spacing = 0;                   ///< mean distance of the returns on the roof, m
  std::size_t returns = 0;              ///< on the roof
  std::vector<SurfacePoint> roof = {};  ///< returns on the roof, in a total order
};

/// Returns the outlines of a region, the largest first. A region of roofs that do not touch has several.
/// - Each cell takes the label of the nearest last return, roof or not. So an edge lies midway between the
/// last
///   return on the roof and the first beside it.
/// - Returns below the roof at its edge are on the wall and have no label.
/// - Holes smaller than 9 m2 are filled: chimneys, skylights, shadows.
/// - `returns`: last returns within roof_surroundings() of the region, in any order.
std::vector<RoofOutline> outline_roof(const RoofCells& cells, const RoofRegion& region,
                                      std::vector<SurfacePoint> returns, const RoofRules& rules);

/// Returns the window of the survey around a region, in cells of the survey.
Window roof_surroundings(const RoofCells& cells, const RoofRegion& region);

}  // namespace waymark::pipeline
