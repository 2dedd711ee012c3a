// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include "core/observation.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/forest/allometry.hpp"
#include "pipeline/forest/find_trees.hpp"
namespace waymark::pipeline {

/// Standard deviations of trees measured in a canopy model.
struct TreeErrors {
  double height = 0.8;  ///< metres; ALS campaigns: 0.6 to 0.8 (Kaartinen et al. 2012)
  /// Relative, of the stem diameter: what an allometry that was not fitted in like stands has in common.
  double allometry = 0;
  /// Stem position along each axis, metres: base + slope x height, since tops lean away from the foot.
  double position_base = 0.3, position_slope = 0.02;
  double crown_relative = 0.2;  ///< relative, of the crown diameter
};

/// Returns the errors of trees of a forest type: conifer, broadleaf, mixed. Laser pulses miss pointed tops,
/// and the built-in allometry of all biomes gives too thin stems of conifers. Figures:
/// docs/evaluation/2026-11-23-feature-deviations.md.
TreeErrors tree_errors(std::string_view forest_type, bool built_in_allometry);

/// Returns a tree as an observation of the landmark type `tree`, positioned at its top. The elevation of the
/// ground is z if known, else 0 with variance NaN. `species`: row of the allometry table.
Observation observation_of(const DetectedTree& tree, const CanopySource& canopy, const LandmarkType& type,
                           TypeId id, std::span<const Allometry> table, std::string_view species,
                           const TreeErrors& errors = {});

}  // namespace waymark::pipeline
