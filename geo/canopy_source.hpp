// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <memory>
#include <string>
#include <vector>
#include "core/grid.hpp"
#include "geo/georeference.hpp"
namespace waymark {

/// Height above ground of a cell that has none. Below every real height, so comparisons need no special case.
inline constexpr float kNoCanopy = -std::numeric_limits<float>::infinity();

/// Values of a raster of forest types; all others mean that the type is not known.
enum class ForestType : std::uint8_t { unknown = 0, conifer = 1, broadleaf = 2, mixed = 3 };

/// One survey of the height of vegetation above ground, read window by window: memory does not depend on its
/// size. Safe to read from many threads.
class CanopySource {
 public:
  virtual ~CanopySource() = default;
  /// Projected or local CRS: windows are metric.
  virtual const GridGeometry& geometry() const = 0;
  /// Heights above ground, metres, [0, 150]; kNoCanopy outside the grid and where nothing is known. Throws
  /// Error where a file is damaged.
  virtual Grid<float> read(const Window& window) const = 0;
  /// Elevation of the ground under one cell, metres; NaN where it is not known.
  virtual double ground(std::int64_t column, std::int64_t row) const = 0;
  /// Type of forest by ForestType, cell by cell; an empty grid where no raster tells it.
  virtual Grid<std::uint8_t> forest_types(const Window& window) const = 0;
  /// Names the survey in observations: its first file without folders.
  virtual const std::string& name() const = 0;
};

/// The surveys of a job, each on its own grid, all in one CRS.
using Canopies = std::vector<std::shared_ptr<const CanopySource>>;

/// The grid of the first survey, extended to all of them: what is cut into tiles. At least one survey.
GridGeometry common_grid(const Canopies& canopies);

/// The cells of a survey's grid whose centres lie in a tile of the common grid. The parts of all tiles are
/// disjoint and cover the survey.
Window part_of(const GridGeometry& grid, const GridGeometry& common, const Window& tile);

}  // namespace waymark
