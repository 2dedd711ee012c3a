// SPDX-License-Identifier: Apache-2.0
#pragma once
namespace waymark::pipeline {

/// Position on a grid, in cells; fractions lie between cell centres.
struct GridPoint {
  double column = 0, row = 0;
  friend bool operator==(const GridPoint&, const GridPoint&) = default;
};

}  // namespace waymark::pipeline
