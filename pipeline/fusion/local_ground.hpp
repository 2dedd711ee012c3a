// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include "geo/terrain.hpp"
#include "pipeline/fusion/sight.hpp"
namespace waymark {

/// The ground about a place: least-squares plane through heights on a ring of `radius` metres (at least one
/// cell of the terrain) and the centre; a level plane where fewer than three are known. Nothing where the
/// height of the place itself is unknown.
std::optional<GroundPlane> local_ground(const Terrain& terrain, double x, double y, double radius);

/// Least-squares plane through points, at their mean; nothing for fewer than three or points in a line.
std::optional<GroundPlane> plane_through(std::span<const Eigen::Vector3d> points);

}  // namespace waymark
