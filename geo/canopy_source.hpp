// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
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

/// Point of the surface: a laser return, or a cell of a raster. Metres.
struct SurfacePoint {
  double x = 0, y = 0;  ///< east and north of the centre of the survey's cell (0, 0)
  double z = 0;         ///< elevation; height above ground where the ground's elevation is unknown
  float height = 0;     ///< above ground
  std::uint8_t number = 0, of = 0;  ///< return `number` of `of`, from 1; 0: unknown, as of rasters
  std::uint8_t classification = 0;  ///< of ASPRS: 2 ground, 3 to 5 vegetation, 6 building

  bool is_first() const { return number <= 1; }
  bool is_last() const { return of == 0 || number >= of; }
  bool is_plant() const { return classification >= 3 && classification <= 5; }
};

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
  /// Returns the elevations of the ground, metres; NaN outside the grid and where unknown.
  virtual Grid<float> ground(const Window& window) const;
  /// Visits the points whose cells lie in the window, in any order: laser returns without noise, or one point
  /// for each cell that has a height. Points over unknown ground are left out.
  virtual void visit_surface(const Window& window, const std::function<void(const SurfacePoint&)>& use) const;
  /// Returns the mean number of first returns per m2; 0 for rasters.
  virtual double point_density() const { return 0; }
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
