// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "pipeline/forest/allometry_fit.hpp"
namespace waymark {

/// Which columns of a table hold what; empty: found by the names in use (height, h, ht, hmax; dbh, d,
/// diameter, stemDiameter; crown_diameter, cd, maxCrownDiameter; species, taxonID, sp; plot, plotID).
struct TreeColumns {
  std::string height = {}, diameter = {}, crown = {}, species = {}, plot = {};
  std::string diameter_unit = {};  ///< cm, m, mm; empty: by the size of the numbers
};

struct MeasuredTrees {
  std::vector<MeasuredTree> trees;
  std::int64_t left_out = 0;  ///< rows without a height or a diameter
  std::string columns;        ///< what was read, for people: "height from H, diameter from DBH in cm"
};

/// Trees of a table (CSV or any OGR layer). Throws Error{input} naming the columns there are where height or
/// diameter is not among them.
MeasuredTrees read_measured_trees(const std::string& path, const TreeColumns& columns);

}  // namespace waymark
