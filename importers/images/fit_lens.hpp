// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>
namespace waymark {

/// A direction and where the lens puts it, both as x/z and y/z.
struct LensPair {
  Eigen::Vector2d straight, seen;
};

struct FittedLens {
  std::array<double, 8> distortion{};  ///< k1 k2 p1 p2 k3, OpenCV's order
  double worst = 0;                    ///< largest distance from a pair, of the focal length
};

/// The Brown lens nearest to the pairs by least squares: for lenses told as the inverse map or by terms that
/// the Brown model has not.
FittedLens fit_brown(const std::vector<LensPair>& pairs);

}  // namespace waymark
