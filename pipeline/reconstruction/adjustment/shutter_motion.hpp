// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>
#include "pipeline/reconstruction/reconstruction.hpp"
namespace waymark::pipeline {

/// Returns the pose of the image of a mark when its row was read out; the image has a pose. The row is that
/// of the mark, not that of its prediction: residuals of a pixel differ by the motion during a row.
Eigen::Isometry3d pose_of_mark(const Reconstruction& scene, const Mark& mark);

/// Motion predicted by the poses of neighbours in time.
struct ExpectedMotion {
  ShutterMotion motion = {};
  double shift_sd = 0;  ///< of each component, in the frame of the reconstruction
  double turn_sd = 0;   ///< of each component, radians
  /// The shift is the sum of the centres of these images times their factors.
  std::vector<std::pair<std::size_t, double>> centres = {};
};

/// Returns the motions of the images whose lens has a rolling shutter: the slope of the parabola through the
/// poses of three neighbours in time. None for images without pose or time, or without a neighbour of another
/// time in their component.
/// - The deviations follow from the third differences of the poses. They are at least 2 % of the motion and
/// 0.2
///   degrees per second.
/// - Times in whole seconds add their rounding. Of fewer than four images the deviation is the motion itself.
/// - Cost: one sort of the images.
std::vector<std::optional<ExpectedMotion>> expected_motions(const Reconstruction& scene);

/// Gives the posed images of rolling shutters that have no motion the expected one. Returns how many have
/// one.
std::size_t expect_motions(Reconstruction& scene);

}  // namespace waymark::pipeline
