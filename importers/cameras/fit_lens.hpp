// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>
namespace waymark::importers {

/// A direction without and with distortion, both as x/z and y/z.
struct LensPair {
  Eigen::Vector2d undistorted, distorted;
};

struct FittedLens {
  std::array<double, 8> distortion{};  ///< k1 k2 p1 p2 k3, OpenCV's order
  double max_error = 0;                ///< largest distance from a pair, of the focal length
};

/// Fits a Brown lens to the pairs by least squares, for lenses given as the inverse map or with terms that
/// the Brown model lacks.
FittedLens fit_brown(const std::vector<LensPair>& pairs);

}  // namespace waymark::importers
