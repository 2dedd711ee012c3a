// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include "geo/terrain.hpp"
#include "pipeline/fusion/projection/viewing_ray.hpp"
namespace waymark::pipeline {

/// Fits a plane to the terrain: least squares through heights at the centre and on a ring of `radius` metres
/// (at least one cell). Level if fewer than three heights are known.
/// `std::nullopt` if the height at the centre is unknown.
std::optional<GroundPlane> local_ground_plane(const Terrain& terrain, double x, double y, double radius);

/// Fits a least-squares plane through points, at their mean. `std::nullopt` for fewer than three or collinear
/// points.
std::optional<GroundPlane> fit_plane(std::span<const Eigen::Vector3d> points);

}  // namespace waymark::pipeline
