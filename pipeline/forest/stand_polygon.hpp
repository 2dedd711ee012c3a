// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>
namespace waymark::pipeline {

/// Area of a stand: outer rings and holes together, metres. A point is inside if an odd number of rings
/// surround it, so holes need no marking. Rings may be closed or open, in any orientation.
struct StandPolygon {
  std::vector<std::vector<Eigen::Vector2d>> rings;
};

/// Returns square metres of the even-odd interior. Requires rings that cross neither themselves nor each
/// other.
double area(const StandPolygon& stand);

/// Returns the box about all rings.
Eigen::AlignedBox2d bounds(const StandPolygon& stand);

/// Returns whether a point is inside. A point on an edge that two polygons share (the same two corners) is
/// inside exactly one. O(corners).
bool inside(const StandPolygon& stand, const Eigen::Vector2d& place);

/// Returns metres to the nearest edge, for points inside and outside; infinity without rings. O(corners).
double distance_to_edge(const StandPolygon& stand, const Eigen::Vector2d& place);

/// Returns the part of a stand in a box (Sutherland & Hodgman 1974, ring by ring); without rings if they do
/// not intersect.
StandPolygon clip_polygon(const StandPolygon& stand, const Eigen::AlignedBox2d& box);

/// Estimates the sampled area from tree positions, for data without a polygon: convex hull, scaled about
/// its centroid by 1 / sqrt(1 - m / n) for m of n trees on the hull (Ripley & Rasson 1977). Empty for fewer
/// than four trees or collinear trees.
StandPolygon estimate_sampled_area(const std::vector<Eigen::Vector2d>& trees);

}  // namespace waymark::pipeline
