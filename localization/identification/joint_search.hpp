// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "localization/identification/identification.hpp"
namespace waymark {

/// One way to pair all sightings of a set: for each its candidate, or -1.
using JointChoice = std::vector<int>;

/// Joint compatibility branch and bound (Neira & Tardos 2001): the most pairings that pass the gate together,
/// among those the least joint distance; landmarks at most once. Nothing where `node_limit` is reached first.
std::optional<JointChoice> most_compatible(std::span<const Candidates> sets, const Eigen::Matrix3d& pose,
                                           const IdentificationOptions& options);

struct JointHypothesis {
  JointChoice choice;
  JointEvidence evidence;
  double probability = 0;  ///< among all hypotheses of the set
  double log_weight = 0;   ///< ln of the density of the set under it, for comparing sets of several poses
};

/// All ways to pair a set, with their probabilities: Gaussian densities of the joint innovations times the
/// landmarks' qualities against a density of clutter for each unpaired sighting. Most probable first; those
/// below 1e-6 of the first are left out. Nothing where `node_limit` is reached.
std::optional<std::vector<JointHypothesis>> joint_hypotheses(std::span<const Candidates> sets,
                                                             const SightingSet& seen, const LandmarkGrid& map,
                                                             const Eigen::Matrix3d& pose,
                                                             const IdentificationOptions& options);

}  // namespace waymark
