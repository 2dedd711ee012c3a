// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "core/observation.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/forest/allometry.hpp"
#include "pipeline/forest/find_trees.hpp"
namespace waymark {

/// How well a canopy model tells a tree: standard deviations.
struct TreeErrors {
  double height = 0.8;  ///< metres; ALS campaigns: 0.6 to 0.8 (Kaartinen et al. 2012)
  /// Of the stem's place along each axis, metres: a top leans away from its foot.
  double place_base = 0.3, place_slope = 0.02;
  double crown_share = 0.2;  ///< of the crown's diameter
};

/// A tree as an observation of the landmark type `tree`, placed at its top, at the elevation of the ground
/// where that is known (else 0, its variance NaN). `species`: row of the allometry table.
Observation observation_of(const FoundTree& tree, const CanopySource& canopy, const LandmarkType& type,
                           TypeId id, std::span<const Allometry> table, std::string_view species,
                           const TreeErrors& errors = {});

}  // namespace waymark
