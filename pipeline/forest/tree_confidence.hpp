// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <vector>
#include "geo/canopy_source.hpp"
#include "pipeline/forest/treetops.hpp"
namespace waymark::pipeline {

/// Evidence that separates a tree from a secondary top of another crown.
struct TopEvidence {
  double height = 0;  ///< of the smoothed canopy, metres
  double roughness =
      0;  ///< RMS of the canopy about the smoothed one in the 5 x 5 cells about the top, metres
  bool has_rival = false;  ///< a higher top is within kRivalReach
  /// For the rival with the smallest distance x drop, whose crown this top most likely belongs to. The drop
  /// is the descent of the canopy on the straight line to it, as a fraction of the height of this top.
  double distance = 0, drop = 0;
};

inline constexpr double kRivalReach = 10;  ///< metres

/// Returns the evidence of the top `index` of `tops`, which are in row order and include all tops within
/// kRivalReach.
TopEvidence top_evidence(const CanopyWindow& raw, const CanopyWindow& smooth,
                         const std::vector<Treetop>& tops, std::size_t index);

/// Returns the probability that a top is a separate tree, [0.1, 0.99]: a logistic function per forest type,
/// `unknown` as mixed. Fitted to synthetic forests of the testbed and to ones with several leaders and
/// rough bark (tests/pipeline/forest/tree_confidence_test.cpp). docs/methods/trees.md reports its
/// calibration.
double tree_confidence(const TopEvidence& evidence, ForestType type);

/// Returns the regression terms: 1; has_rival; ln(drop + 0.01) and ln(distance) of rivals; ln(roughness +
/// 0.02); ln(height).
std::array<double, 6> regression_terms(const TopEvidence& evidence);

}  // namespace waymark::pipeline
