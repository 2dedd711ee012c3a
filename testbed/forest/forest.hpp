// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
namespace waymark::testbed {

/// Standing tree, metres, GridFrame. `species` is an index into ForestModel::species; 0 if there is only one.
struct StandingTree {
  Eigen::Vector3d foot = Eigen::Vector3d::Zero();  ///< centre of the stem at ground level
  double height = 0;                               ///< foot to highest shoot (tree height)
  double dbh = 0;                                  ///< stem diameter at 1.3 m, over bark; 0: below 1.3 m
  double crown_diameter = 0;                       ///< mean width
  double crown_base = 0;                           ///< height above the foot where the living crown begins
  int species = 0;

  friend bool operator==(const StandingTree&, const StandingTree&) = default;
};

}  // namespace waymark::testbed
