// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geo/crs.hpp"
#include "importers/points/canopy_terrain.hpp"
#include "importers/points/las_catalogue.hpp"
namespace waymark::importers {

/// Returns the common CRS of all files, or `asked`; local with a warning if they name none.
/// Throws Error{input} if the files differ, or if the points seem to be in degrees.
Crs crs_of_points(const std::vector<LasHeader>& headers, const std::string& asked, const LasBox& box,
                  std::vector<std::string>& warnings);

/// Warns that the ground of unclassified points is found by its shape. `unit`: metres per unit of the CRS.
/// Throws Error{input} at `file` if there are too few points for that.
void check_density(const LasCatalogue& points, double unit, const std::string& file,
                   std::vector<std::string>& warnings);

/// Points of a survey and the terrain model below them.
struct PointsOnTerrain {
  const LasCatalogue& points;
  const CanopyTerrain& terrain;
  const GridGeometry& grid;  ///< of the surface
  double unit, height_unit;  ///< metres per unit of the points
};

/// Compares returns of the ground with the terrain model in squares spread over the survey, and warns if they
/// differ by more than their errors. Throws Error{input} at `file` if they surely have different datums.
void compare_with_terrain(const PointsOnTerrain& survey, const std::string& file,
                          std::vector<std::string>& warnings);

}  // namespace waymark::importers
