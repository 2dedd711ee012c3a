// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>
namespace waymark {

/// The ground of a stand: outer rings and holes together, metres. A place is inside where an odd number of
/// rings surround it, so holes and islands in them need no telling apart. Rings are closed or not, in any
/// sense.
struct StandPolygon {
  std::vector<std::vector<Eigen::Vector2d>> rings;
};

/// Square metres: by the trapezoid rule over the even-odd inside. Right for rings that do not cross
/// themselves or each other.
double area(const StandPolygon& stand);

Eigen::AlignedBox2d bounds(const StandPolygon& stand);

/// Half-open: of two polygons that share an edge (the same two corners) a place on it is in exactly one.
/// O(corners).
bool inside(const StandPolygon& stand, const Eigen::Vector2d& place);

/// Metres to the nearest edge, inside and outside alike; infinity without rings. O(corners).
double distance_to_edge(const StandPolygon& stand, const Eigen::Vector2d& place);

/// The part of a stand in a box (Sutherland & Hodgman 1974, ring by ring); without rings where there is none.
StandPolygon clipped(const StandPolygon& stand, const Eigen::AlignedBox2d& box);

/// The ground `trees` were drawn from, where nothing else tells it: their convex hull, enlarged about its
/// centroid by 1 / sqrt(1 - m / n) for m of n trees on the hull (Ripley & Rasson 1977). Empty for fewer than
/// four trees or trees on a line.
StandPolygon ground_of(const std::vector<Eigen::Vector2d>& trees);

}  // namespace waymark
