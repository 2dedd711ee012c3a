// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
#include "pipeline/reconstruction/surface/choose_views.hpp"
#include "pipeline/reconstruction/surface/image_levels.hpp"
#include "pipeline/reconstruction/surface/path_costs.hpp"
#include "pipeline/reconstruction/surface/refine_heights.hpp"
#include "pipeline/reconstruction/surface/surface_grid.hpp"
namespace waymark::pipeline {

/// Reason for which a cell has no height, a value of the band of dem.tif.
enum class NoHeight : std::uint8_t {
  none = 0,          ///< it has a height
  not_seen = 1,      ///< fewer than two comparable views
  margin = 2,        ///< the window extends beyond the images of all but one view
  texture = 3,       ///< texture below the noise in all views but one
  low_score = 4,     ///< the images differ at every height
  ambiguous = 5,     ///< a second height fits as well
  range_end = 6,     ///< the best height is the end of the search
  disagreement = 7,  ///< two halves of the views give different heights
  accuracy = 8,      ///< the expected standard deviation exceeds the limit
  hidden = 9,        ///< the DEM hides the cell from the views used
  jump = 10,         ///< off the plane of its neighbours or off the coarser surface
  island = 11,       ///< part of too small a patch
};
inline constexpr int kNoHeightReasons = 12;

/// Returns the text of a reason for reports: "texture below noise".
const char* reason_text(NoHeight reason);

/// Numbers that decide which heights are kept; see docs/methods/heights_from_images.md.
struct SweepRules {
  ViewRules views = {};
  PathPenalties penalties = {};
  double step_pixels = 0.35;  ///< parallax of a height step at the typical angle
  int refine_steps = 8;      ///< searched on each side of the coarser surface: 1.4 pixels of the coarser pass
  double best_pairs = 0.75;  ///< fraction of the pairs whose mean is the score of a step
  double min_texture = 1;    ///< standard deviation of a window over that of the noise
  double min_score = 0.5;
  double min_lead = 0.05;       ///< of the best score before the second peak
  double max_disagreement = 3;  ///< of the two halves, in standard deviations of their difference
  double max_sd = 2.6;          ///< expected standard deviation before refinement, ground sample distances
  double max_refined_sd = 1.7;  ///< the same after it
  double max_jump = 4;     ///< from the coarser surface, in the larger of node spacing and standard deviation
  double match_sd = 0.15;  ///< factor of the standard deviation from the curvature of the score
  double pixel_sd = 0.22;  ///< of a parallax, pixels: what the score does not show
  double relief_sd = 0.15;  ///< of the relief that windows smooth, node spacings
  RefineRules refine = {};  ///< of the cells of the last pass
};

/// What one pass of the sweep works on.
struct SweepPass {
  const std::vector<SurfaceView>& views;
  ImageLevels& images;
  const SweepRules& rules;
  SurfaceGrid grid;         ///< of the nodes
  const Grid<float>& base;  ///< heights at the nodes about which heights are searched
  HiddenTest hidden = {};
  double half_range = 0;  ///< metres on each side of the base; 0: `refine_steps`
};

/// Heights of the nodes of a chunk, row by row.
struct ChunkHeights {
  Window window;  ///< of the nodes
  std::vector<float> height, sd, score, angle, gsd;
  std::vector<std::uint8_t> views;
  std::vector<NoHeight> reason;
  std::vector<std::uint32_t> block;  ///< index into `blocks`
  std::vector<ChosenViews> blocks;
};

/// Side of a chunk and the width of its surroundings that its paths cover, nodes. Chunks are aligned with the
/// grid, so that results depend on neither tiles nor threads.
inline constexpr std::int64_t kChunk = 256, kChunkHalo = 32, kBlock = 32;

/// Sweeps one chunk: window scores at each height step, 8-path costs, refinement below a step, and the checks
/// that need a node alone. `column` and `row` are multiples of kChunk.
ChunkHeights sweep_chunk(const SweepPass& pass, std::int64_t column, std::int64_t row);

}  // namespace waymark::pipeline
