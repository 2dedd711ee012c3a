// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>
#include "geo/dem_source.hpp"
#include "pipeline/terrain/grid_point.hpp"
#include "pipeline/terrain/relief_pyramid.hpp"
namespace waymark::pipeline {

/// End point of the isolation (the paper's "topographical dominance") of a summit.
enum class IsolationEnd {
  cell,     ///< nearest strictly higher cell, as in other tools
  contact,  ///< nearest interpolated point of equal elevation on the path to higher terrain, as in the paper
};

/// How distances are measured.
enum class DistanceKind {
  geodesic,  ///< geodesic on the body's ellipsoid
  planar,    ///< straight line on the projected map
};

/// Where isolation ends, and how it is measured.
struct IsolationOptions {
  IsolationEnd end = IsolationEnd::cell;
  DistanceKind distance = DistanceKind::geodesic;
};

/// Cell with its height.
struct HighPoint {
  std::int64_t cell = 0;
  double height = 0;
};

/// Distance from a summit to higher terrain.
struct Isolation {
  std::optional<double> metres;  ///< absent if nothing in the data is higher
  std::optional<double>
      metres_low;    ///< certified lower bound, as unknown terrain may be higher; absent if unbounded
  GridPoint higher;  ///< end point; only with `metres`
  friend bool operator==(const Isolation&, const Isolation&) = default;
};

/// Throws Error{usage} for planar distances on a geographic grid; the hint names a projection that fits.
void check_distance(DistanceKind distance, const GridGeometry& grid);

/// Computes the exact isolation of each summit, in the same order.
/// - Best-first search in the pyramid of highest cells: blocks in order of their smallest possible distance,
///   until none can contain a nearer cell. Fine cells are read from the DEM in chunks.
/// - Nearest cell and final distance are exact geodesics. Among cells at equal distance the smallest index is
///   taken.
/// - Contact: the terrain falls linearly from each higher cell to its eight neighbours; isolation ends at the
///   nearest point of the contour of the summit's elevation. At most one cell diagonal less than `cell`.
/// Runs on the threads of the current TBB arena; `done` receives the number of finished summits, from any
/// thread. Throws Error{usage} for planar distances on a geographic grid.
std::vector<Isolation> measure_isolation(std::span<const HighPoint> summits, const DemSource& dem,
                                         const ReliefPyramid& relief, const IsolationOptions& options,
                                         const std::function<void(std::size_t)>& done = {});

}  // namespace waymark::pipeline
