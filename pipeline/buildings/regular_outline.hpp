// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
#include "pipeline/buildings/roof_outline.hpp"
namespace waymark::pipeline {

/// How an outline was drawn.
enum class OutlineKind {
  regular,  ///< straight walls along two perpendicular directions, others where the edge requires them
  cells,    ///< along the edges of the cells: no walls could be fitted
};

/// Polygon of walls. Wall i leads from vertex i to the next one.
struct RegularRing {
  std::vector<Eigen::Vector2d> vertices;
  std::vector<double> sd;  ///< of each wall across its direction, m
};

struct RegularOutline {
  RegularRing outer;               ///< counter-clockwise
  std::vector<RegularRing> holes;  ///< clockwise
  OutlineKind kind = OutlineKind::regular;
  double direction = 0;  ///< of the first of the two directions, counter-clockwise from x, [0, pi/2)
};

/// Fits walls to the edges of a roof.
/// - The edge is divided into straight pieces so that squared distances plus a price per piece are least
///   (minimum description length; Sohn et al. 2012), by dynamic programming. Pieces lie along the dominant
///   direction or across it (Sampath and Shan 2007), or at a higher price along any direction.
/// - Steps of a wall less than 0.6 m, or 1.25 spacings of the returns, are not resolved.
/// - A polygon that would intersect itself, or leaves the edge, is replaced by that of the cells.
/// Cost: the square of the number of cells along the edge, at most 1500.
RegularOutline regularise(const RoofOutline& roof);

/// Returns whether no two walls of a ring intersect or touch, neighbours aside. O(n^2).
bool is_simple(const std::vector<Eigen::Vector2d>& ring);

/// Returns the area of a ring, positive if it runs counter-clockwise.
double ring_area(const std::vector<Eigen::Vector2d>& ring);

}  // namespace waymark::pipeline
