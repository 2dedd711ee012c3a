// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <string>
#include <vector>
#include "core/grid.hpp"
#include "geo/georeference.hpp"
namespace waymark {

/// What no-data cells mean (a choice, never a guess).
enum class NodataPolicy {
  ocean,    ///< below everything and never crossed; nothing is hidden there
  unknown,  ///< never crossed, but ground of any height may be hidden there: bounds are certified against it
  fill,     ///< interpolated from the rim as gdal_fillnodata does; what stays empty is unknown
};

/// Height of a cell that has none. Below every real height, so comparisons need no special case.
inline constexpr double kNoHeight = -std::numeric_limits<double>::infinity();

/// Cells of a window with their heights in metres; kNoHeight where there is no data.
using HeightWindow = Grid<double>;

/// A DEM that is read window by window: memory does not depend on its size. Safe to read from many threads.
class DemSource {
 public:
  virtual ~DemSource() = default;
  virtual const GridGeometry& geometry() const = 0;
  virtual NodataPolicy nodata_policy() const = 0;
  /// Heights of the window, metres. Columns outside [0, columns) wrap round where the grid wraps; all other
  /// cells outside the grid have kNoHeight. Never NaN or +infinity. Throws Error where the file is damaged.
  virtual HeightWindow read(const Window& window) const = 0;
  /// Standard deviation of a height in metres, 0 if not known.
  virtual double height_sd() const { return 0; }
  /// For provenance and messages: file names, in the order of priority.
  virtual std::vector<std::string> files() const = 0;
};

}  // namespace waymark
