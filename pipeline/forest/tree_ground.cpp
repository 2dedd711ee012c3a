// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/tree_ground.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/vision/real_fraction.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kNarrowestCrown = 0.1;  // diameter over height

// Of the trees of five canopy models 99 % or more have the shape of a tree, of the tops of bright pictures 6
// to 31 % (docs/evaluation/2026-11-27-second-look-at-detectors.md).
constexpr PropertyLimits kTreeShape{.alien = 0.8, .usual = 0.95};

// Marked trees of Eureka: 90 to 100 % per image exceed either.
constexpr double kMinInfraredIndex = 0.1, kMinExcessGreen = 0.02;
constexpr double kGreenTrees = 0.9;

/// Returns how many crowns of another colour trees can have.
double max_other(const CrownColours& seen) {
  const double expected = (1 - kGreenTrees) / kGreenTrees * static_cast<double>(seen.green);
  return expected + 2 * std::sqrt(expected + 1);
}

}  // namespace

void TreeShapes::add(double height, double crown_diameter) {
  ++trees;
  possible += height <= kTallestTree && crown_diameter >= kNarrowestCrown * height;
}

double TreeShapes::real_fraction() const {
  return pipeline::real_fraction(possible, trees, kTreeShape);
}

std::string tree_shapes_warning(const TreeShapes& seen) {
  return fmt::format(
      "{:.0f} % of {} supposed trees are taller than {:g} m or have crowns narrower than a tenth of their "
      "height (at most 5 % of trees): this band holds no heights above ground, but perhaps brightness or "
      "elevations; the confidences are lowered so that at most {:.0f} % count as real",
      100 * static_cast<double>(seen.trees - seen.possible) /
          static_cast<double>(std::max<std::int64_t>(1, seen.trees)),
      seen.trees, kTallestTree, 100 * seen.real_fraction());
}

double CrownColours::real_fraction_of_other() const {
  return other > 0 ? std::min(1.0, max_other(*this) / static_cast<double>(other)) : 1;
}

bool is_vegetation(double index, bool infrared) {
  return index > (infrared ? kMinInfraredIndex : kMinExcessGreen);
}

std::string crown_colours_warning(const CrownColours& seen) {
  return fmt::format(
      "{} of {} supposed crowns have the colour of vegetation (90 % or more among trees), as where rocks, "
      "roofs or shadows are taken for crowns: the confidences of the other {} are lowered so that at most "
      "{:.0f} count as real",
      seen.green, seen.green + seen.other, seen.other, max_other(seen));
}

}  // namespace waymark::pipeline
