// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geo/similarity.hpp"
#include "pipeline/reconstruction/adjustment/adjust.hpp"
namespace waymark::pipeline {

struct Georeferenced {
  bool metric = false;  ///< false: the frame stays arbitrary; `messages` say what is missing
  std::vector<std::string> messages = {};  ///< what was used, left out, is missing
  AdjustmentResult adjustment = {};
};

/// Brings a reconstruction into the map by control points, positions, gravity and a coarse DEM, then adjusts
/// it together with them. Each component finds its start by a robust similarity; components without one lose
/// their poses if another has one. Observations that contradict the others are left out and named. A
/// reconstruction whose frame is metric already is adjusted as it is.
Georeferenced georeference(Reconstruction& scene, const Observations& observations,
                           const AdjustmentOptions& options = {});

/// Moves a component, its images, points and their covariances, by a similarity.
void transform(Reconstruction& scene, std::size_t component, const Similarity& to_from_scene);

}  // namespace waymark::pipeline
