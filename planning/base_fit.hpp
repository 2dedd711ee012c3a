// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "geo/dem_source.hpp"
namespace waymark::planning {

/// Cells that a vehicle's base covers about a cell, and the distance of its wheels' steps.
struct BaseFootprint {
  double cell_x = 1, cell_y = 1;                 ///< metres, size of a cell, > 0
  std::vector<std::int64_t> half_widths;         ///< of row dy: columns -w to w; index 0 is the middle row
  std::int64_t half_columns = 0, half_rows = 0;  ///< of the box of cells that the fit reads
  std::int64_t lag_x = 1, lag_y = 1;             ///< cells, steps along a row or a column
  std::int64_t lag_dx = 1, lag_dy = 1;           ///< cells, diagonal steps
  double quantum = 1;                            ///< metres, heights are rounded to multiples of it

  std::int64_t cells() const;  ///< of the disc
  double xx() const;           ///< sum of x squared over the disc, cells squared
  double yy() const;           ///< sum of y squared over the disc
};

/// Returns the cells of a disc of `radius` metres. The disc holds at least 3 x 3 cells. Steps are
/// taken over `step` metres, at least one cell. Throws Error{input} for a disc of more than 200 cells in
/// radius.
BaseFootprint make_base_footprint(double cell_x, double cell_y, double radius, double step);

/// Relief under the base at a cell.
struct BaseRelief {
  float gradient_x = 0, gradient_y = 0;  ///< of the plane fitted to the disc, metres per metre; y northwards
  float roughness = 0;                   ///< metres, root mean square of the heights about the plane
  float step = 0;  ///< metres, largest change of height over a step within the box, beyond that of the plane
};

/// Returns a plane fitted by least squares, and the steps about it (Chilian & Hirschmueller 2009), for every
/// cell of `inner`. All values are NaN if a cell of the box has no height.
/// - `heights` covers `inner` with a margin of half_columns and half_rows cells; `inner` is relative to it.
/// - Sums run along rows in integers, so a cell has the same value in every window that holds it.
/// - Takes about 50 ns per cell for a disc of 13 rows.
Grid<BaseRelief> fit_base(const HeightWindow& heights, const Window& inner, const BaseFootprint& base);

/// Computes one cell of fit_base() directly from its definition.
BaseRelief fit_base_directly(const HeightWindow& heights, std::int64_t column, std::int64_t row,
                             const BaseFootprint& base);

}  // namespace waymark::planning
