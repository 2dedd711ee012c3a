// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
#include "geo/canopy_source.hpp"
namespace waymark::pipeline {

/// Connected part of the surveyed ground, map coordinates.
struct SurveyedPart {
  std::vector<Eigen::Vector2d> outer;               ///< counter-clockwise on a north-up map, not closed
  std::vector<std::vector<Eigen::Vector2d>> holes;  ///< ground without data inside
};

/// Returns the outline of the ground for which at least one canopy model has data: along the sides of blocks
/// of 1/256 of the longer side of the common grid, or of a cell if that is larger. A grid with data in
/// 99.5 % of its samples gives its rectangle. Gaps of less than 16 blocks are no holes. Reads 256 rows of
/// each canopy.
std::vector<SurveyedPart> survey_outline(const Canopies& canopies);

}  // namespace waymark::pipeline
