// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>
#include "core/landmark.hpp"
#include "core/units.hpp"
#include "geo/dem_source.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/terrain/isolation.hpp"
#include "pipeline/terrain/prominence.hpp"
namespace waymark::pipeline {

struct MountainTopOptions {
  Meters min_isolation{0};  ///< summits nearer than this to higher terrain are left out
  Meters visible_range{10000};
};

struct MountainTops {
  std::vector<Landmark> landmarks;               ///< in row order of their cells
  std::map<std::string, std::int64_t> rejected;  ///< summits by reason
};

/// Converts the summits of a window to landmarks of type mountain_top. `summits` are all of the grid, in row
/// order of their cells, `isolations` in the same order: parents may lie anywhere.
/// - Position: centre of the cell, map CRS. Variance: uniform error over the cell, square metres east and
///   north.
/// - Confidence: the fraction of prominence that unknown terrain cannot reduce.
/// - A parent that was left out is replaced by its nearest ancestor that was not.
/// - Left out and counted: summits near higher terrain, outside the area of interest, or higher or lower than
///   the type allows.
MountainTops mountain_tops(std::span<const Summit> summits, std::span<const Isolation> isolations,
                           const DemSource& dem, const TypeRegistry& types, const MountainTopOptions& options,
                           const Window& window);

}  // namespace waymark::pipeline
