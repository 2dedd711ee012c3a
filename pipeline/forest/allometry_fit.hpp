// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "pipeline/forest/allometry.hpp"
namespace waymark::pipeline {

/// Field measurements of a tree.
struct MeasuredTree {
  std::string species = "all";
  double height = 0;                   ///< metres
  double diameter = 0;                 ///< DBH, centimetres
  double crown = Allometry::kUnknown;  ///< crown diameter, metres
  std::string plot = {};               ///< plots are cross-validated as a whole; empty: each tree by itself
};

struct AllometryFitOptions {
  int min_trees = 20;  ///< minimum for a row of its own, per species
  int folds = 10;
  std::uint64_t seed = 1;
};

/// Fits one row for all trees ("all") and one per species, sorted by name.
/// - D = a x^b by least squares in centimetres, x = H - 1.3. If all trees of a species have a crown diameter,
///   x = H CD is fitted, too. The form with the smaller cross-validated error is kept.
/// - Cross-validation is by plot where plots are named, else by tree.
/// Throws Error{input} if fewer than 5 trees are higher than 1.3 m.
std::vector<Allometry> fit_allometry(std::span<const MeasuredTree> trees,
                                     const AllometryFitOptions& how = {});

}  // namespace waymark::pipeline
