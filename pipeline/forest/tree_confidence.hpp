// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>
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

/// Terms of the regression: 1; has_rival; ln(drop + 0.01) and ln(distance) of rivals; ln(roughness + 0.02);
/// ln(height).
using TreetopTerms = std::array<double, 6>;
TreetopTerms regression_terms(const TopEvidence& evidence);

/// Coefficients of a logistic function per type of forest: conifer, broadleaf, mixed.
struct TreeConfidenceModel {
  std::array<TreetopTerms, 3> weights{};
  std::string trained_on;  ///< provenance, one line of text
};

/// Returns the probability that a top is a separate tree, [0.1, 0.99]; `unknown` as mixed.
double tree_confidence(const TreeConfidenceModel& model, const TopEvidence& evidence, ForestType type);
/// Returns the same by the shipped model.
double tree_confidence(const TopEvidence& evidence, ForestType type);

/// Writes a model as text of kind `treetops` (pipeline/vision/network_text.hpp): one layer of five inputs and
/// three outputs.
std::string as_text(const TreeConfidenceModel& model);
/// Throws Error{input} that names `where`.
TreeConfidenceModel parse_tree_confidence(std::string_view text, const std::string& where);

/// Returns the shipped model, made by `waymark train trees`
/// (pipeline/forest/built_in_tree_confidence.cpp). docs/methods/trees.md reports its calibration.
const TreeConfidenceModel& built_in_tree_confidence();

}  // namespace waymark::pipeline
