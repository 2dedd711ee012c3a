// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>
#include "geo/crs.hpp"
namespace waymark::importers {

/// Outline of a stand, from a polygon layer.
struct StandOutline {
  using Ring = std::vector<Eigen::Vector2d>;  ///< closed
  std::string name;                           ///< unique: duplicates get a number appended
  std::string species;                        ///< empty: unknown
  std::vector<std::vector<Ring>>
      polygons;  ///< per part the outer ring, then holes; units of the requested CRS
};

struct StandOutlines {
  std::vector<StandOutline> stands;
  std::vector<std::string> warnings;  ///< overlaps, repairs, an assumed CRS
  std::vector<std::string> failed;    ///< stands without an area: one sentence each
};

/// Reads polygons of any layer GDAL reads, `/vsi...` paths included, in the CRS `into`.
/// - A column stand, stand_id, name, plot, plot_id, id or fid (in any case) names the stands, else their
///   number; a column species, type or forest_type gives the species.
/// - A polygon that crosses itself is repaired (GEOS), with a warning.
/// - Lines, points and empty geometries fail one by one.
/// - Every pair of stands that overlap by more than a square metre gives a warning.
/// - A layer without a CRS is taken to be in `into`; if `into` is local, every layer is.
/// Throws Error{input} if there is no such file, no layer or no polygon, and for another body.
StandOutlines read_stand_outlines(const std::string& path, const std::string& layer, const Crs& into);

}  // namespace waymark::importers
