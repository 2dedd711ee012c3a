// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "pipeline/forest/allometry.hpp"
namespace waymark {

/// A tree measured in the field.
struct MeasuredTree {
  std::string species = "all";
  double height = 0;                   ///< metres
  double diameter = 0;                 ///< DBH, centimetres
  double crown = Allometry::kUnknown;  ///< crown diameter, metres
  std::string plot = {};               ///< trees of one plot are held out together; empty: each tree alone
};

struct AllometryFit {
  int least_trees = 20;  ///< species with fewer get no row of their own
  int folds = 10;
  std::uint64_t seed = 1;
};

/// One row for all trees together ("all") and one per species, sorted by name. D = a x^b is fitted by least
/// squares in centimetres, x = H - 1.3; of species whose trees all have a crown diameter also x = H CD, and
/// the form with the smaller held-out error is kept. Held-out errors come from cross-validation by plot where
/// plots are named, by tree elsewhere. Throws Error{input} where fewer than 5 trees are higher than 1.3 m.
std::vector<Allometry> fit_allometry(std::span<const MeasuredTree> trees, const AllometryFit& how = {});

}  // namespace waymark
