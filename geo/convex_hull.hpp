// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
namespace waymark::inline geo {

/// Returns the convex hull of points, counter-clockwise, without points on its edges and not closed (monotone
/// chain, Andrew 1979). O(n log n).
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

}  // namespace waymark::inline geo
