// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "pipeline/reconstruction/adjustment/adjust.hpp"
#include "pipeline/reconstruction/reconstruction.hpp"
namespace waymark::test {

struct MadeSceneOptions {
  std::uint64_t seed = 1;
  int columns = 4, rows = 3;  ///< of the grid of cameras
  double base = 25;           ///< between cameras, metres; they fly at 100 m, and each sees 100 m x 75 m
  double relief = 10;         ///< of the ground, metres
  double tilt = 0;            ///< of the cameras, alternately to all sides, radians
  int points = 200;
  double mark_sd = 0.5;  ///< pixels
  Camera camera = {.columns = 1000, .rows = 750, .fx = 1000, .fy = 1000, .cx = 499.5, .cy = 374.5};
  Eigen::Vector3d corner = {0, 0, 0};  ///< of the ground
};

/// Aerial block with its truth.
struct MadeScene {
  pipeline::Reconstruction truth = {};
  pipeline::Reconstruction start = {};  ///< truth with disturbed poses (0.5 m, 0.01 rad) and points (0.5 m)
  pipeline::Observations seen = {};     ///< empty
};

MadeScene made_scene(const MadeSceneOptions& options);

/// Returns positions of all cameras with Gaussian errors.
std::vector<pipeline::ObservedPosition> made_positions(const pipeline::Reconstruction& truth, double sd,
                                                       std::uint64_t seed);
/// Returns surveyed points over the ground, with marks in all images that see them and Gaussian errors.
std::vector<pipeline::ControlPoint> made_control(const MadeScene& scene, const MadeSceneOptions& options,
                                                 int columns, int rows, double sd);

}  // namespace waymark::test
