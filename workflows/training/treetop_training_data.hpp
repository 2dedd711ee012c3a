// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "pipeline/engine/progress.hpp"
#include "pipeline/forest/tree_confidence.hpp"
namespace waymark::workflows {

/// Detected treetop of a synthetic forest.
struct ScoredTreetop {
  pipeline::TopEvidence evidence;
  double predicted = 0;  ///< confidence by the shipped model
  bool is_tree = false;  ///< highest detection on its crown
};

/// Returns the detections in a rough_forest(), except those within 5 m of its border.
std::vector<ScoredTreetop> score_rough_forest(std::uint64_t seed, ForestType type);

/// Returns the detections in a hectare of the testbed, with smooth, separate crowns. A detection is the
/// nearest tree within 2.5 m that no higher detection has taken.
std::vector<ScoredTreetop> score_testbed_forest(std::uint64_t seed, ForestType type);

/// Trains the confidence of treetops on `forests` rough forests of each type (seeds from 0) and a third as
/// many of the testbed (seeds from 70 000). The same for any number of threads. 120 forests take ten CPU
/// seconds.
pipeline::TreeConfidenceModel train_tree_confidence(int forests, int threads,
                                                    const pipeline::ProgressListener& progress);

}  // namespace waymark::workflows
