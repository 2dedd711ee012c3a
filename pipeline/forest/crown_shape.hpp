// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/engine/codec.hpp"
namespace waymark {

/// The crown of a tree as a polygon on the map. Crowns of one canopy model do not overlap.
struct CrownShape {
  std::string uid;                                ///< of the tree's landmark; empty until crowns are named
  std::string source;                             ///< canopy model it was drawn on, as Observation::source
  Eigen::Vector2d top = Eigen::Vector2d::Zero();  ///< treetop in the map CRS: Observation::position.xyz.xy
  std::vector<Eigen::Vector2d>
      ring;             ///< outline in the map CRS, counter-clockwise; the first is not repeated
  double height = 0;    ///< of the tree, m
  double area = 0;      ///< of the crown seen from above, m2
  double diameter = 0;  ///< of the circle of that area, m
};

/// The artifact `crowns`.
template <>
struct Codec<std::vector<CrownShape>> {
  static std::string encode(const std::vector<CrownShape>& crowns);
  static std::vector<CrownShape> decode(std::string_view bytes);
};

}  // namespace waymark
