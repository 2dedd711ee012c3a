// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <memory>
#include <string>
#include <vector>
#include "core/grid.hpp"
#include "geo/georeference.hpp"
namespace waymark::inline geo {

/// Height above ground of a cell without data. Less than every real height; comparisons need no special case.
inline constexpr float kNoCanopy = -std::numeric_limits<float>::infinity();

/// Values of a raster of forest types; all other values are unknown.
enum class ForestType : std::uint8_t { unknown = 0, conifer = 1, broadleaf = 2, mixed = 3 };

/// Canopy height model of one survey, read by windows: memory does not depend on its size. Thread-safe.
class CanopySource {
 public:
  virtual ~CanopySource() = default;
  /// Returns the grid, in a projected or local CRS.
  virtual const GridGeometry& geometry() const = 0;
  /// Returns heights above ground, metres, [0, 150]; kNoCanopy outside the grid and for unknown cells. Throws
  /// Error if a file is damaged.
  virtual Grid<float> read(const Window& window) const = 0;
  /// Returns the elevation of the ground at one cell, metres; NaN if unknown.
  virtual double ground_elevation(std::int64_t column, std::int64_t row) const = 0;
  /// Returns the ForestType of each cell; an empty grid if the survey has no raster of types.
  virtual Grid<std::uint8_t> forest_types(const Window& window) const = 0;
  /// Returns whether a position in the map's CRS lies in the area of interest; without one, everywhere.
  virtual bool in_area(double, double) const { return true; }
  /// Returns the name of the survey in observations: its first file without folders.
  virtual const std::string& name() const = 0;
};

/// Surveys of a job, each on its own grid, all in one CRS.
using Canopies = std::vector<std::shared_ptr<const CanopySource>>;

/// Returns the grid of the first survey, extended to all surveys; its tiles are the units of work. Throws
/// std::logic_error without surveys.
GridGeometry common_grid(const Canopies& canopies);

/// Returns the window of a survey's cells whose centres lie in a tile of the common grid. The windows of all
/// tiles are disjoint and cover the survey.
Window tile_window(const GridGeometry& grid, const GridGeometry& common, const Window& tile);

}  // namespace waymark::inline geo
