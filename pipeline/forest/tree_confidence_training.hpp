// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include "pipeline/forest/tree_confidence.hpp"
namespace waymark::pipeline {

/// Detected treetop and whether it is a separate tree.
struct TreetopExample {
  TopEvidence evidence;
  bool is_tree = false;
};

/// Fits the coefficients of one type of forest: logistic regression by 40 Newton steps, with a ridge of 0.01.
/// They are rounded to three decimals, which makes them independent of the order of sums.
TreetopTerms fit_tree_confidence(std::span<const TreetopExample> examples);

}  // namespace waymark::pipeline
