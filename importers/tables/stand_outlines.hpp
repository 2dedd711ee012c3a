// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>
#include "geo/crs.hpp"
namespace waymark {

/// A stand as a layer of polygons draws it.
struct StandOutline {
  using Ring = std::vector<Eigen::Vector2d>;  ///< closed
  std::string name;                           ///< unique: what stands twice gets a number behind it
  std::string species;                        ///< empty: not told
  std::vector<std::vector<Ring>>
      polygons;  ///< per part the outer ring, then holes; units of the CRS asked for
};

struct StandOutlines {
  std::vector<StandOutline> stands;
  std::vector<std::string> warnings;  ///< overlaps, repairs, a CRS that had to be taken for granted
  std::vector<std::string> failed;    ///< stands that are no area: one sentence each
};

/// Reads polygons of any layer GDAL reads, `/vsi...` paths too, in the CRS `into`. A column named stand,
/// stand_id, name, plot, plot_id, id or fid (upper or lower case) names the stands, else their number; a
/// column species, type or forest_type tells the species. A polygon that crosses itself is repaired (GEOS)
/// and told; lines, points and empty geometries fail one by one. Every pair of stands that overlap by more
/// than a square metre is told. A layer without a CRS is taken to be in `into`; with a local `into` every
/// layer is. Throws Error{input}: no such file, no layer, no polygon at all, another body.
StandOutlines read_stand_outlines(const std::string& path, const std::string& layer, const Crs& into);

}  // namespace waymark
