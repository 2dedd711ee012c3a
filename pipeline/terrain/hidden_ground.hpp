// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include "geo/dem_source.hpp"
namespace waymark::pipeline {

/// Metres above the datum; a void beside ground above this is taken for a gap, not for the sea.
inline constexpr double kMaxShore = 100;

/// Returns the height above which a cell next to a void shows that the void hides terrain.
/// - Policies `unknown` and `fill`: every void does (-infinity).
/// - Policy `ocean` on Earth, and without a body: kMaxShore, so that gaps in mountains lower the certified
///   bounds. Cliffs higher than that do so as well.
/// - Other bodies have no sea, so every void does.
inline double hidden_above(const DemSource& dem) {
  const Crs& crs = dem.geometry().where.crs;
  const bool sea = crs.kind() == CrsKind::local || crs.body().name == earth().name;
  return dem.nodata_policy() == NodataPolicy::ocean && sea ? kMaxShore
                                                           : -std::numeric_limits<double>::infinity();
}

}  // namespace waymark::pipeline
