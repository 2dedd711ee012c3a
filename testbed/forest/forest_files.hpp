// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geo/crs.hpp"
#include "testbed/forest/forest_scan.hpp"
namespace waymark {

/// Truth lists as CSV, coordinates in units of the CRS (`unit` metres each), all else in metres.
/// `trees`: type,x,y,z,height,diameter,crown_diameter,crown_base,species,stand,exposed - as `waymark evaluate
/// landmarks` takes it; `exposed`: share of the crown no other stands over. `understory`: the trees below 7
/// cm dbh, with the same columns, which nobody is blamed for missing.
struct ForestTruth {
  std::string trees, understory;
};
ForestTruth forest_truth(const ForestLaw& law, const MadeForest& forest, const std::vector<double>& exposed,
                         double unit);

/// The stands as GeoJSON polygons with the columns stand and density (asked for). The CRS is named as older
/// GeoJSON does; a local one is not.
std::string stands_geojson(const MadeForest& forest, const Crs& crs, double unit);

/// The job that makes a map of the trees: chm.tif beside it.
std::string forest_job(const std::string& name, const ForestLaw& law, const std::string& crs);

}  // namespace waymark
