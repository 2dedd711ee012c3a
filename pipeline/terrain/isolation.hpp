// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>
#include "geo/dem_source.hpp"
#include "pipeline/terrain/ground_metric.hpp"
#include "pipeline/terrain/relief_pyramid.hpp"
namespace waymark {

/// Where the isolation (the paper's "topographical dominance") of a summit ends.
enum class IsolationEnd {
  cell,     ///< the nearest cell that is strictly higher: what all other tools report
  contact,  ///< the nearest point of equal elevation on the way to higher ground, interpolated: the paper's
            ///< words
};

enum class DistanceKind {
  geodesic,  ///< on the body's ellipsoid
  planar,    ///< on the projected map
};

struct IsolationOptions {
  IsolationEnd end = IsolationEnd::cell;
  DistanceKind distance = DistanceKind::geodesic;
};

/// A cell and its height.
struct HighPoint {
  std::int64_t cell = 0;
  double height = 0;
};

struct Isolation {
  std::optional<double> metres;  ///< absent where nothing in the data is higher
  std::optional<double>
      metres_low;  ///< certified: hidden ground may be higher; absent where nothing is known to end it
  Place higher;    ///< where it ends; only with `metres`
  friend bool operator==(const Isolation&, const Isolation&) = default;
};

/// Exact isolation of each summit, in the same order. Best-first search in the pyramid of highest cells:
/// blocks in the order of the least distance any of their cells can have, until none can hold a nearer cell.
/// Fine cells are read from the DEM in chunks as they are needed. The nearest cell and the final distance are
/// exact geodesics; of cells at the same distance the one with the smallest index is taken. Contact: around
/// each higher cell the ground falls linearly to its eight neighbours; the isolation ends where the line of
/// the summit's elevation between those crossings is nearest. At most one cell diagonal less than `cell`.
/// Runs on the threads of the current TBB arena; `done` is told how many summits are finished, from any
/// thread. Throws Error{usage} for planar distances on a geographic grid.
std::vector<Isolation> measure_isolation(std::span<const HighPoint> summits, const DemSource& dem,
                                         const ReliefPyramid& relief, const IsolationOptions& options,
                                         const std::function<void(std::size_t)>& done = {});

}  // namespace waymark
