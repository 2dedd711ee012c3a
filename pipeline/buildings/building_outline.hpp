// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/engine/codec.hpp"
namespace waymark::pipeline {

/// Outline of a building on the map.
struct BuildingOutline {
  std::string uid = {};                                  ///< of the building's landmark
  std::string source = {};                               ///< survey, as Observation::source
  std::string roof = {};                                 ///< RoofKind
  std::string outline = {};                              ///< OutlineKind: regular, cells
  std::vector<std::vector<Eigen::Vector2d>> rings = {};  ///< in the map CRS: outer, then courtyards
  double height = 0, area = 0, slope = 0;                ///< m, m2, radians
  double wall_sd = 0;                                    ///< mean of the walls across their directions, m
  double density = 0;                                    ///< last returns per m2
  double confidence = 1;
};

/// The artifact `footprints`.
template <>
struct Codec<std::vector<BuildingOutline>> {
  static std::string encode(const std::vector<BuildingOutline>& footprints);
  static std::vector<BuildingOutline> decode(std::string_view bytes);
};

}  // namespace waymark::pipeline
