// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>
#include "exporters/view/view_frame.hpp"
#include "exporters/view/view_scene.hpp"
namespace waymark::exporters {

/// Bounds of the terrain in a page.
struct TerrainBudget {
  std::int64_t nodes = 448;    ///< of the mesh along its longer side
  std::int64_t pixels = 1536;  ///< of the picture along its longer side
};

/// Returns the rectangle of the view frame that a DEM covers; `std::nullopt` if no name is a DEM.
std::optional<Eigen::AlignedBox2d> dem_area(const std::vector<std::string>& dems, const ViewFrame& frame);

/// Makes the terrain of a rectangle of the view frame, averaged to the budget.
/// - The picture is the orthophoto if there is one, shaded relief where it has no pixels.
/// - Without DEM the terrain is empty, with an orthophoto a plane at `level` metres of the view frame.
/// Throws Error{input} for an orthophoto that is no image, is rotated or is of another CRS.
ViewTerrain make_view_terrain(const std::vector<std::string>& dems, const std::string& orthophoto,
                              const ViewFrame& frame, const Eigen::AlignedBox2d& area, double level,
                              const TerrainBudget& budget = {});

}  // namespace waymark::exporters
