// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <vector>
#include "geo/canopy_source.hpp"
#include "pipeline/forest/treetops.hpp"
namespace waymark {

/// What tells a tree from a second top of another tree's crown.
struct TopEvidence {
  double height = 0;  ///< of the smoothed canopy, metres
  double roughness =
      0;  ///< RMS of the canopy about the smoothed one in the 5 x 5 cells about the top, metres
  bool rivalled = false;  ///< a higher top stands within kRivalReach
  /// Of the one whose crown this top most likely belongs to: least distance x drop. The drop is how far the
  /// canopy descends on the straight line to it, as a share of this top's height.
  double distance = 0, drop = 0;
};

inline constexpr double kRivalReach = 10;  ///< metres

/// Of the top number `index` of `tops`, which are in row order and hold all tops within kRivalReach.
TopEvidence evidence_of(const CanopyWindow& raw, const CanopyWindow& smooth, const std::vector<Treetop>& tops,
                        std::size_t index);

/// Probability that a top is a tree of its own, [0.1, 0.99]: a logistic function of the evidence for each
/// type of forest, `unknown` as mixed. Fitted to forests of the testbed and to made ones whose crowns have
/// several leaders and rough bark (tests/forest/tree_confidence_test.cpp); docs/trees.md tells how well it
/// holds.
double tree_confidence(const TopEvidence& evidence, ForestType type);

/// 1; rivalled? 1 : 0, ln(drop + 0.01) and ln(distance) of rivals; ln(roughness + 0.02); ln(height): what the
/// coefficients multiply.
std::array<double, 6> terms_of(const TopEvidence& evidence);

}  // namespace waymark
