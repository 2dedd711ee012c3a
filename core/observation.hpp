// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include "core/feature.hpp"
#include "core/frames.hpp"
namespace waymark::inline core {

using TypeId = std::uint16_t;  ///< index into the TypeRegistry

/// Single observation of a landmark, projected to the terrain.
struct Observation {
  TypeId type = 0;
  std::string landmark_uid;              ///< landmark that it supports; empty if rejected
  std::string source;                    ///< image name, or the DEM
  std::optional<Eigen::Vector2d> pixel;  ///< column, row; (0, 0) is the centre of the first pixel
  Point<MapCrs> position;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y of the map CRS, up; square metres
  double confidence = 1;                                 ///< detection quality q(d), (0, 1]
  FeatureSet features;
  std::string rejected;  ///< reason; empty if accepted
};

}  // namespace waymark::inline core
