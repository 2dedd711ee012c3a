// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "localization/identification/identification.hpp"
namespace waymark::localization {

/// A joint association: the candidate of each sighting, or -1.
using JointChoice = std::vector<int>;

/// Searches by joint compatibility branch and bound (Neira & Tardos 2001). Returns the association with the
/// most pairings that pass the gate together, among those the least joint distance; each landmark at most
/// once. `std::nullopt` if `node_limit` is reached first.
std::optional<JointChoice> joint_compatibility(std::span<const Candidates> sets, const Eigen::Matrix3d& pose,
                                               const IdentificationOptions& options);

/// A joint association and its probability.
struct JointHypothesis {
  JointChoice choice;
  JointEvidence evidence;
  double probability = 0;  ///< among all hypotheses of the set
  double log_weight = 0;   ///< ln of the density of the set, to compare sets of several poses
};

/// Returns all joint associations with their probabilities, most probable first. The probability is the
/// Gaussian density of the joint innovations times the landmarks' probabilities of existence, against a
/// clutter density for each unpaired sighting. Omits those below 1e-6 of the first. `std::nullopt` if
/// `node_limit` is reached.
std::optional<std::vector<JointHypothesis>> joint_hypotheses(std::span<const Candidates> sets,
                                                             const SightingSet& seen, const LandmarkGrid& map,
                                                             const Eigen::Matrix3d& pose,
                                                             const IdentificationOptions& options);

}  // namespace waymark::localization
