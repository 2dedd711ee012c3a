// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
namespace waymark::pipeline {
struct MeasuredTree;
}

namespace waymark::importers {

/// Names of the columns of a tree table. Empty: recognised by the usual names (height, h, ht, hmax; dbh, d,
/// diameter, stemDiameter; crown_diameter, cd, maxCrownDiameter; species, taxonID, sp; plot, plotID).
struct TreeColumns {
  std::string height = {}, diameter = {}, crown = {}, species = {}, plot = {};
  std::string diameter_unit = {};  ///< cm, m, mm; empty: inferred from the numbers
};

/// Trees read from a table.
struct MeasuredTrees {
  std::vector<pipeline::MeasuredTree> trees;
  std::int64_t skipped_rows = 0;  ///< rows without a height or a diameter
  std::string columns;            ///< the columns used, for people: "height from H, diameter from DBH in cm"
};

/// Reads trees from a table (CSV or any OGR layer). Throws Error{input} with the column names if height or
/// diameter is not among them.
MeasuredTrees read_measured_trees(const std::string& path, const TreeColumns& columns);

}  // namespace waymark::importers
