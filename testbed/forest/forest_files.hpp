// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geo/crs.hpp"
#include "testbed/forest/forest_scan.hpp"
namespace waymark::testbed {

/// Truth tables as CSV; coordinates in units of the CRS (`unit` metres each), everything else in metres.
/// - `trees`: type,x,y,z,height,diameter,crown_diameter,crown_base,species,stand,exposed, as read by
///   `waymark evaluate landmarks`. `exposed`: fraction of the crown that no other overtops.
/// - `understory`: trees below 7 cm DBH, same columns, ignored in evaluation.
struct ForestTruth {
  std::string trees, understory;
};
ForestTruth forest_truth(const ForestModel& law, const SyntheticForest& forest,
                         const std::vector<double>& exposed, double unit);

/// Returns the stands as GeoJSON polygons with the columns stand and density (nominal). The CRS is named as
/// in older GeoJSON; a local CRS is omitted.
std::string stands_geojson(const SyntheticForest& forest, const Crs& crs, double unit);

/// Returns the job that maps the trees of chm.tif in the same folder.
std::string forest_job(const std::string& name, const ForestModel& law, const std::string& crs);

}  // namespace waymark::testbed
