// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <string>
#include <vector>
#include "core/grid.hpp"
#include "geo/georeference.hpp"
namespace waymark::inline geo {

/// Meaning of no-data cells; chosen by the user, never guessed.
enum class NodataPolicy {
  ocean,    ///< lower than all cells and never crossed; contains no terrain beside low ground
  unknown,  ///< never crossed; may contain terrain of any height, which certified bounds account for
  fill,     ///< interpolated from the edges as by gdal_fillnodata; remaining gaps are unknown
};

/// Height of a cell without data. Less than every real height, so comparisons need no special case.
inline constexpr double kNoHeight = -std::numeric_limits<double>::infinity();

/// Heights of a window in metres; kNoHeight for cells without data.
using HeightWindow = Grid<double>;

/// Heights beyond these limits are faults of the file and count as no data: no known body has relief that far
/// from its reference surface (Vesta -22 km, Mars +22 km).
inline constexpr double kMinHeight = -30000;
inline constexpr double kMaxHeight = 30000;  ///< see kMinHeight

/// What became of the cells of a window that hold no usable height in the files.
struct CellFaults {
  std::int64_t filled = 0;       ///< without height, interpolated (NodataPolicy::fill)
  std::int64_t implausible = 0;  ///< outside [kMinHeight, kMaxHeight]
  double height = 0;             ///< of the first implausible cell, metres
  std::int64_t column = 0, row = 0;
};

/// DEM read by windows: memory does not depend on its size. Thread-safe.
class DemSource {
 public:
  virtual ~DemSource() = default;
  virtual const GridGeometry& geometry() const = 0;
  virtual NodataPolicy nodata_policy() const = 0;
  /// Returns the heights of the window, metres; never NaN or +infinity. Columns outside [0, columns) wrap if
  /// the grid wraps; all other cells outside the grid are kNoHeight. Throws Error if the file is damaged.
  virtual HeightWindow read(const Window& window) const = 0;
  /// Returns whether a position in the map's CRS lies in the area of interest; without one, everywhere.
  virtual bool in_area(double, double) const { return true; }
  /// Counts the faults of a window inside the grid.
  virtual CellFaults faults(const Window&) const { return {}; }
  /// Returns the standard deviation of a height in metres, 0 if unknown.
  virtual double height_sd() const { return 0; }
  /// Returns the file names for provenance and messages, in the order of priority.
  virtual std::vector<std::string> files() const = 0;
};

}  // namespace waymark::inline geo
