// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <functional>
#include <optional>
#include "pipeline/reconstruction/surface/coarse_heights.hpp"
#include "pipeline/reconstruction/surface/start_heights.hpp"
#include "pipeline/reconstruction/surface/sweep_chunk.hpp"
namespace waymark::pipeline {

/// Where heights are searched, and how.
struct SweepPlan {
  SurfaceGrid grid = {};                     ///< of the cells of the DEM
  HeightRange range = {};                    ///< of the terrain
  std::optional<CoarseHeights> coarse = {};  ///< on `range` where it is unknown
  SweepRules rules = {};
  int levels = 3;  ///< passes at half the size of the one before, ahead of the finest

  std::size_t image_bytes = std::size_t{1} << 30;  ///< memory for images; changes the time only
  std::function<void(double done)> progress = {};  ///< from one thread at a time, 0 to 1
  /// Returns the kept result of a chunk, or that of `compute`; called from several threads. Empty: nothing is
  /// kept. `item` names pass and chunk; the results depend on views and plan alone.
  std::function<ChunkHeights(const std::string& item, const std::function<ChunkHeights()>& compute)> keep =
      {};
};

/// DEM from images: bands of dem.tif.
struct SurfaceHeights {
  SurfaceGrid grid;
  Grid<float> height;         ///< metres; NaN: none, see `reason`
  Grid<float> sd;             ///< of matching, independent beyond a few cells; metres
  Grid<float> systematic_sd;  ///< of the poses and lenses, common to regions; metres
  Grid<float> angle;          ///< largest between views compared, degrees
  Grid<float> score;          ///< mean correlation of the better half of the pairs
  Grid<std::uint8_t> views;   ///< compared
  Grid<std::uint8_t> reason;  ///< NoHeight
  std::array<std::int64_t, kNoHeightReasons> counts{};  ///< cells by reason; sums to all cells

  std::int64_t kept() const { return counts[0]; }
};

/// Measures heights by sweeping a surface through object space, coarse to fine, with semi-global matching
/// over the height steps (docs/methods/heights_from_images.md). Nodes lie at half the cell; a cell is the
/// mean of its four. The result depends on neither threads, memory nor the order of the images. Throws
/// Error{input} if an image cannot be read.
SurfaceHeights sweep_heights(const std::vector<SurfaceView>& views, const SweepPlan& plan);

}  // namespace waymark::pipeline
