// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "core/landmark.hpp"
#include "core/units.hpp"
#include "geo/dem_source.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/terrain/isolation.hpp"
#include "pipeline/terrain/prominence.hpp"
namespace waymark {

struct MountainTopOptions {
  Meters min_isolation{0};  ///< summits nearer than this to higher ground are left out
  Meters visible_range{10000};
};

/// The summits as landmarks of type mountain_top, in row order of their cells. `isolations` in the order of
/// `summits`. Position: centre of the cell, map CRS; its variance is that of a uniform error over the cell,
/// in square metres east and north. Confidence: the share of its prominence that hidden ground cannot take
/// away. A parent that was left out is replaced by the nearest of its own parents that was not.
std::vector<Landmark> mountain_tops(std::span<const Summit> summits, std::span<const Isolation> isolations,
                                    const DemSource& dem, const TypeRegistry& types,
                                    const MountainTopOptions& options);

}  // namespace waymark
