// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/crs.hpp"
#include "workflows/planning/route.hpp"
namespace waymark::workflows {

/// Writes routes by the output's extension: .gpkg with the layers `route` and `route_station`, .geojson with
/// both kinds of features in the map's CRS, .csv with the stations of the first route. Throws Error{output}.
void write_routes(const RouteRequest& request, const Crs& crs, const RouteResult& result);

}  // namespace waymark::workflows
