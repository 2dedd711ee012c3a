// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include "core/observation.hpp"
#include "geo/terrain.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/ground_outline.hpp"
namespace waymark {

/// How well a rim stands above its floor all round, in diameters: the 15th percentile over 36 azimuths of the
/// crest (0.9 to 1.2 radii), less the lowest fifth of the floor, both above the plane of the surroundings. A
/// slope, a scarp or a valley has it near 0 where an image is deceived. Nothing below three cells of the
/// terrain and where heights are unknown.
std::optional<double> closed_rim(const Terrain& terrain, const GroundOutline& outline);

/// Makes the confidence of each observation of craters that of image and heights together. How far closed
/// rims are trusted is learnt from the observations, which are of one image: by how far apart they lie for
/// what probably is a crater and for what probably is none, against their spread (weights: the confidences;
/// five observations each say in advance what landings showed). Heights that do not show what the image is
/// sure of change nothing. Positions in units of `metres_per_unit`.
void weigh_by_rims(std::span<Observation> observations, const TypeRegistry& types, const Terrain& terrain,
                   double metres_per_unit);

}  // namespace waymark
